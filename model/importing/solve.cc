#include <algorithm>
#include <cstddef>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/strip.h"
#include "model/base/statistics.h"
#include "model/base/status_macros.h"
#include "model/dataset/dataset.h"
#include "model/importing/import.h"
#include "model/importing/steps.h"
#include "model/solver/body_model.h"
#include "model/solver/person.h"

namespace duet::importing {
namespace {

namespace fs = std::filesystem;
using motion::Poses;
using motion::Vec3;

constexpr std::size_t kMostListed = 5;
// Bones of optical captures vary by less than this, of depth cameras by several times as much.
// Metres, mean of a data set.
constexpr double kNoisyBones = 0.002;

// The path of a solved sequence: its class's folder, and a name from its place in the data set.
PairFiles PathOf(const dataset::Dataset& dataset, const dataset::Sequence& sequence) {
  PairFiles files;
  const std::string place(
      absl::StripSuffix(absl::StripSuffix(sequence.id, "/skeleton_pos.txt"), ".txt"));
  const std::size_t slash = place.find('/');
  const bool own_folder = slash != std::string::npos && sequence.set.empty();
  files.label = sequence.labels.empty()
                    ? dataset.classes[static_cast<std::size_t>(sequence.interaction_class)]
                : own_folder ? place.substr(0, slash)
                             : "takes";
  files.name = absl::StrReplaceAll(own_folder ? place.substr(slash + 1) : place, {{"/", "_"}});
  files.first = files.second = sequence.id;
  files.subjects = sequence.subjects;
  return files;
}

dataset::DatasetLayout LayoutOf(const dataset::Dataset& dataset) {
  dataset::DatasetLayout layout;
  layout.name = dataset.name;
  layout.frame_rate_hz = dataset.frame_rate_hz;
  layout.skeleton = dataset.skeleton;
  layout.parts = dataset.parts;
  for (std::size_t i = 0; i < dataset.classes.size(); ++i) {
    dataset::ClassLayout one;
    one.name = one.folder = dataset.classes[i];
    one.symmetric = dataset.symmetric[i];
    one.handed = dataset.handed[i];
    one.touches = dataset.touches[i];
    layout.classes.push_back(std::move(one));
  }
  const auto& direction = dataset.sequences[0].partner_direction;
  if (direction) layout.people_axis = direction->x != 0 ? Vec3{1, 0, 0} : Vec3{0, 0, 1};
  return layout;
}

// Whether the bones of the people vary.
bool HasNoisyBones(const dataset::Dataset& dataset) {
  std::vector<double> noise;
  for (const dataset::Sequence& sequence : dataset.sequences) {
    for (const motion::Clip* person : {&sequence.pair.leader, &sequence.pair.follower}) {
      noise.push_back(solver::BodyModel::BoneNoise(dataset.skeleton, person->poses));
    }
  }
  return base::Mean(noise) > kNoisyBones;
}

// Solves both people. `ways` receives the way of every joint, metres.
absl::StatusOr<SolvedSequence> SolvePair(const dataset::Dataset& dataset, bool one_floor,
                                         dataset::Sequence* sequence, std::vector<double>* ways) {
  Poses* const people[] = {&sequence->pair.leader.poses, &sequence->pair.follower.poses};
  double floors[] = {solver::StandingHeight(dataset.skeleton, *people[0]),
                     solver::StandingHeight(dataset.skeleton, *people[1])};
  if (one_floor) floors[0] = floors[1] = (floors[0] + floors[1]) / 2;
  SolvedSequence moved{sequence->id, 0};
  for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
    absl::StatusOr<Poses> solved =
        solver::SolvePerson(dataset.skeleton, *people[i], dataset.frame_rate_hz, floors[i]);
    if (!solved.ok()) {
      return absl::InvalidArgumentError(
          absl::StrCat(sequence->id, ": ", solved.status().message()));
    }
    std::vector<double> own;
    for (std::size_t p = 0; p < solved->all().size(); ++p) {
      own.push_back(Distance(people[i]->all()[p], solved->all()[p]));
    }
    moved.metres = std::max(moved.metres, base::Mean(own));
    ways->insert(ways->end(), own.begin(), own.end());
    *people[i] = *std::move(solved);
  }
  return moved;
}

// Solves a data set in place.
absl::Status SolveAll(dataset::Dataset* dataset, SolveReport* report) {
  const bool one_floor = HasNoisyBones(*dataset);
  std::vector<double> ways;
  for (dataset::Sequence& sequence : dataset->sequences) {
    DUET_TRY(report->most_moved.emplace_back(), SolvePair(*dataset, one_floor, &sequence, &ways));
  }
  report->sequences = static_cast<int>(dataset->sequences.size());
  report->moved = base::Mean(ways);
  std::vector<SolvedSequence>& moved = report->most_moved;
  std::sort(moved.begin(), moved.end(),
            [](const SolvedSequence& a, const SolvedSequence& b) { return a.metres > b.metres; });
  moved.resize(std::min(moved.size(), kMostListed));
  return absl::OkStatus();
}

}  // namespace

absl::Status Solve(const fs::path& from, const fs::path& out, bool overwrite, SolveReport* report) {
  DUET_RETURN_IF_ERROR(CheckOut(out, overwrite));
  DUET_TRY(dataset::Dataset dataset, dataset::ReadDataset(from));
  const Poses& first = dataset.sequences[0].pair.leader.poses;  // names what the skeleton lacks
  DUET_RETURN_IF_ERROR(solver::BodyModel::Measure(dataset.skeleton, first).status());
  DUET_RETURN_IF_ERROR(SolveAll(&dataset, report));
  std::vector<ImportedSequence> sequences;
  for (dataset::Sequence& sequence : dataset.sequences) {
    const bool stated = sequence.leader_source == "index";
    sequences.push_back({{PathOf(dataset, sequence), std::move(sequence.pair.leader),
                          std::move(sequence.pair.follower)},
                         dataset::LeaderSide::kLeft,
                         stated ? "index" : absl::StrCat("guess: ", sequence.leader_source),
                         std::move(sequence.labels)});
  }
  return WriteDataset(out, LayoutOf(dataset), sequences);
}

}  // namespace duet::importing

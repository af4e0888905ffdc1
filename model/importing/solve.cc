#include <algorithm>
#include <cstddef>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/strip.h"
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

class Mean {
 public:
  void Add(double value) {
    sum_ += value;
    ++count_;
  }
  double value() const { return count_ > 0 ? sum_ / count_ : 0; }

 private:
  double sum_ = 0;
  int count_ = 0;
};

// The path of a solved sequence: its class's folder, and a name from its place in the data set.
PairFiles PathOf(const dataset::Dataset& dataset, const dataset::Sequence& sequence) {
  PairFiles files;
  std::string place = sequence.id;
  if (absl::EndsWith(place, "/skeleton_pos.txt")) {
    place.resize(place.size() - std::string("/skeleton_pos.txt").size());
  }
  place = std::string(absl::StripSuffix(place, ".txt"));
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

// Solves a data set in place.
class Solving {
 public:
  explicit Solving(dataset::Dataset* dataset) : dataset_(*dataset), skeleton_(dataset->skeleton) {}

  absl::Status Run(SolveReport* report) {
    Mean noise;
    for (const dataset::Sequence& sequence : dataset_.sequences) {
      noise.Add(solver::BodyModel::BoneNoise(skeleton_, sequence.pair.leader.poses));
      noise.Add(solver::BodyModel::BoneNoise(skeleton_, sequence.pair.follower.poses));
    }
    noisy_ = noise.value() > kNoisyBones;
    for (dataset::Sequence& sequence : dataset_.sequences) {
      if (absl::Status status = SolvePair(&sequence); !status.ok()) return status;
    }
    report->sequences = static_cast<int>(dataset_.sequences.size());
    report->moved = moved_.value();
    std::sort(sequences_.begin(), sequences_.end(),
              [](const SolvedSequence& a, const SolvedSequence& b) { return a.metres > b.metres; });
    sequences_.resize(std::min(sequences_.size(), kMostListed));
    report->most_moved = sequences_;
    return absl::OkStatus();
  }

 private:
  absl::Status SolvePair(dataset::Sequence* sequence) {
    Poses* const people[] = {&sequence->pair.leader.poses, &sequence->pair.follower.poses};
    double floors[] = {solver::StandingHeight(skeleton_, *people[0]),
                       solver::StandingHeight(skeleton_, *people[1])};
    if (noisy_) floors[0] = floors[1] = (floors[0] + floors[1]) / 2;
    SolvedSequence moved{sequence->id, 0};
    for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
      absl::StatusOr<Poses> solved =
          solver::SolvePerson(skeleton_, *people[i], dataset_.frame_rate_hz, floors[i]);
      if (!solved.ok()) {
        return absl::InvalidArgumentError(
            absl::StrCat(sequence->id, ": ", solved.status().message()));
      }
      moved.metres = std::max(moved.metres, MeasureWay(*people[i], *solved));
      *people[i] = *std::move(solved);
    }
    sequences_.push_back(std::move(moved));
    return absl::OkStatus();
  }

  double MeasureWay(const Poses& captured, const Poses& solved) {
    Mean own;
    for (std::size_t i = 0; i < captured.all().size(); ++i) {
      const double way = Distance(captured.all()[i], solved.all()[i]);
      own.Add(way);
      moved_.Add(way);
    }
    return own.value();
  }

  dataset::Dataset& dataset_;
  const motion::Skeleton& skeleton_;
  bool noisy_ = false;  // bones vary
  Mean moved_;
  std::vector<SolvedSequence> sequences_;
};

absl::Status CheckSkeleton(const dataset::Dataset& dataset) {
  const dataset::Sequence& sequence = dataset.sequences[0];
  return solver::BodyModel::Measure(dataset.skeleton, sequence.pair.leader.poses).status();
}

}  // namespace

absl::Status Solve(const fs::path& from, const fs::path& out, bool overwrite, SolveReport* report) {
  if (absl::Status status = CheckOut(out, overwrite); !status.ok()) return status;
  absl::StatusOr<dataset::Dataset> dataset = dataset::ReadDataset(from);
  if (!dataset.ok()) return dataset.status();
  absl::Status status = CheckSkeleton(*dataset);
  if (status.ok()) status = Solving(&*dataset).Run(report);
  if (!status.ok()) return status;
  std::vector<ImportedSequence> sequences;
  for (dataset::Sequence& sequence : dataset->sequences) {
    const bool stated = sequence.leader_source == "index";
    sequences.push_back({{PathOf(*dataset, sequence), std::move(sequence.pair.leader),
                          std::move(sequence.pair.follower)},
                         dataset::LeaderSide::kLeft,
                         stated ? "index" : absl::StrCat("guess: ", sequence.leader_source),
                         std::move(sequence.labels)});
  }
  return WriteDataset(out, LayoutOf(*dataset), sequences);
}

}  // namespace duet::importing

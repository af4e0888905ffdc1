#include "model/evaluation/baselines/baselines.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "model/base/random.h"
#include "model/base/status_macros.h"
#include "model/evaluation/baselines/class_models.h"

namespace duet::evaluation::baselines {
namespace {

struct Entry {
  const char* name;
  // Learns a model of each class; null: holds the follower's first pose.
  std::unique_ptr<ClassModel> (*learn)(const std::vector<StandardPair>& pairs);
};

constexpr Entry kBaselines[] = {
    {"class_mean", LearnClassMean},
    {"frozen_first_frame", nullptr},
    {"nearest_neighbour", LearnNearestNeighbour},
    {"hmm", LearnHmm},
    {"kzbh12", LearnDiscreteMdp},
    {"hk14", LearnKernelRl},
    {"hfkb15", LearnMaxEntIoc},
};

// Shapes: returns [classes].
absl::StatusOr<std::vector<std::unique_ptr<ClassModel>>> LearnClasses(
    const Entry& entry, const dataset::Dataset& dataset, const std::vector<int>& train) {
  std::vector<std::vector<StandardPair>> by_class(dataset.classes.size());
  for (const int i : train) {
    const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(i)];
    by_class[static_cast<size_t>(sequence.interaction_class)].push_back(
        StandardiseSequence(dataset.skeleton, sequence));
  }
  std::vector<std::unique_ptr<ClassModel>> models;
  for (size_t c = 0; c < by_class.size(); ++c) {
    if (by_class[c].empty()) {
      return absl::InvalidArgumentError(absl::StrCat(entry.name,
                                                     ": expected a training sequence of class ",
                                                     dataset.classes[c], ", got none"));
    }
    models.push_back(entry.learn(by_class[c]));
  }
  return models;
}

// The captured followers of a class that can answer a clip of `frames` frames.
std::vector<const dataset::Sequence*> Candidates(const dataset::Dataset& dataset,
                                                 const std::vector<int>& train,
                                                 int interaction_class, int frames) {
  std::vector<const dataset::Sequence*> all, enough;
  for (const int index : train) {
    const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(index)];
    if (sequence.interaction_class != interaction_class) continue;
    all.push_back(&sequence);
    if (sequence.pair.leader.frame_count() >= frames) enough.push_back(&sequence);
  }
  return enough.empty() ? all : enough;
}

}  // namespace

std::vector<std::string> BaselineNames() {
  std::vector<std::string> names;
  for (const Entry& entry : kBaselines) names.push_back(entry.name);
  return names;
}

absl::StatusOr<std::vector<metrics::ScoredMotion>> RunBaseline(const std::string& name,
                                                               const dataset::Dataset& dataset,
                                                               const dataset::Split& split) {
  const Entry& entry = *std::find_if(std::begin(kBaselines), std::end(kBaselines),
                                     [&](const Entry& one) { return one.name == name; });
  std::vector<std::unique_ptr<ClassModel>> models;
  if (entry.learn != nullptr) {
    DUET_TRY(models, LearnClasses(entry, dataset, split.train));
  }
  std::vector<metrics::ScoredMotion> answers;
  for (const int index : split.test) {
    const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(index)];
    motion::Poses answer(0, dataset.skeleton.joint_count());
    if (entry.learn == nullptr) {
      for (int t = 0; t < sequence.pair.leader.frame_count(); ++t) {
        answer.Append(sequence.pair.follower.poses[0]);
      }
    } else {
      const ClassModel& model = *models[static_cast<size_t>(sequence.interaction_class)];
      const Rows follower = model.Predict(StandardLeader(dataset.skeleton, sequence));
      answer = BaselineStandardisation(dataset.skeleton, sequence).Invert(FromRows(follower));
    }
    const auto all = answer.all();
    if (!std::all_of(all.begin(), all.end(), [](motion::Vec3 p) { return IsFinite(p); })) {
      return absl::InternalError(absl::StrCat(name, ": ", sequence.id,
                                              ": expected finite positions, got one that is not"));
    }
    answers.push_back({index, std::move(answer)});
  }
  return answers;
}

absl::StatusOr<std::vector<metrics::ScoredMotion>> AnswerWithOtherPeople(
    const dataset::Dataset& dataset, const dataset::Split& split, uint64_t seed) {
  constexpr auto kFirstFrame = motion::StandardOrigin::kFirstFrame;
  base::Random random(seed);
  std::vector<metrics::ScoredMotion> answers;
  for (const int index : split.test) {
    const dataset::Sequence& asked = dataset.sequences[static_cast<size_t>(index)];
    const int frames = asked.pair.leader.frame_count();
    const auto candidates = Candidates(dataset, split.train, asked.interaction_class, frames);
    if (candidates.empty()) {
      return absl::InvalidArgumentError(absl::StrCat(
          "other people: expected at least one training sequence of class ",
          dataset.classes[static_cast<size_t>(asked.interaction_class)], ", got none"));
    }
    const auto drawn = random.Below(static_cast<int64_t>(candidates.size()));
    const dataset::Sequence& other = *candidates[static_cast<size_t>(drawn)];
    const Rows motion = ToRows(BaselineStandardisation(dataset.skeleton, other, kFirstFrame)
                                   .Apply(other.pair.follower.poses));
    const Rows fitted =
        motion.rows() < frames ? StretchTo(motion, frames) : Rows(motion.topRows(frames));
    answers.push_back(
        {index,
         BaselineStandardisation(dataset.skeleton, asked, kFirstFrame).Invert(FromRows(fitted))});
  }
  return answers;
}

}  // namespace duet::evaluation::baselines

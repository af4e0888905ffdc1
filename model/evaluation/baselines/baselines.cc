#include "model/evaluation/baselines/baselines.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/base/random.h"
#include "model/base/status_macros.h"
#include "model/base/text.h"
#include "model/evaluation/baselines/class_models.h"
#include "model/motion/standardise.h"

namespace duet::evaluation::baselines {
namespace {

// The sequence without its follower, so that a method that reads the answer fails instead of
// scoring well.
dataset::Sequence WithoutAnswer(const dataset::Sequence& sequence, bool keep_first_pose) {
  dataset::Sequence hidden = sequence;
  hidden.pair.follower.poses.Resize(keep_first_pose ? 1 : 0);
  return hidden;
}

absl::Status CheckAnswer(const dataset::Sequence& sequence, const motion::Poses& answer) {
  const motion::Clip& leader = sequence.pair.leader;
  if (answer.frame_count() != leader.frame_count() ||
      answer.joint_count() != leader.joint_count()) {
    return absl::InternalError(absl::StrCat("answer: expected the leader's ", leader.frame_count(),
                                            " frames of ", leader.joint_count(), " joints, got ",
                                            answer.frame_count(), " of ", answer.joint_count()));
  }
  const absl::Span<const motion::Vec3> all = answer.all();
  if (std::all_of(all.begin(), all.end(), [](motion::Vec3 p) { return IsFinite(p); })) {
    return absl::OkStatus();
  }
  return absl::InternalError("answer: expected finite positions, got one that is not");
}

absl::StatusOr<motion::Poses> Answer(const Method& method, const dataset::Sequence& sequence) {
  absl::StatusOr<motion::Poses> answer =
      method.Predict(WithoutAnswer(sequence, method.reads_first_pose()));
  const absl::Status status = answer.ok() ? CheckAnswer(sequence, *answer) : answer.status();
  if (status.ok()) return answer;
  return absl::Status(status.code(),
                      absl::StrCat(method.name(), ": ", sequence.id, ": ", status.message()));
}

}  // namespace

absl::StatusOr<std::vector<metrics::ScoredMotion>> RunFold(const dataset::Dataset& dataset,
                                                           const dataset::Split& split,
                                                           Method* method) {
  DUET_RETURN_IF_ERROR(method->Train(dataset, split.train));
  std::vector<metrics::ScoredMotion> motions;
  for (const int i : split.test) {
    const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(i)];
    DUET_TRY(motion::Poses answer, Answer(*method, sequence));
    motions.push_back({i, std::move(answer)});
  }
  return motions;
}

namespace {

using Learn = std::unique_ptr<ClassModel> (*)(const std::vector<StandardPair>& pairs);

// A method that learns one model for each interaction class.
class PerClassMethod : public Method {
 public:
  PerClassMethod(std::string name, Learn learn) : name_(std::move(name)), learn_(learn) {}

  std::string name() const override { return name_; }

  absl::Status Train(const dataset::Dataset& dataset, const std::vector<int>& train) override {
    skeleton_ = dataset.skeleton;
    models_.clear();
    std::vector<std::vector<StandardPair>> by_class(dataset.classes.size());
    for (const int i : train) {
      const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(i)];
      by_class[static_cast<size_t>(sequence.interaction_class)].push_back(
          StandardiseSequence(skeleton_, sequence));
    }
    for (size_t i = 0; i < by_class.size(); ++i) {
      if (by_class[i].empty()) {
        return absl::InvalidArgumentError(absl::StrCat(
            name_, ": expected a training sequence of class ", dataset.classes[i], ", got none"));
      }
      models_.push_back(learn_(by_class[i]));
    }
    return absl::OkStatus();
  }

  absl::StatusOr<motion::Poses> Predict(const dataset::Sequence& sequence) const override {
    const ClassModel& model = *models_[static_cast<size_t>(sequence.interaction_class)];
    return FollowerToWorld(skeleton_, sequence, model.Predict(StandardLeader(skeleton_, sequence)));
  }

 private:
  const std::string name_;
  const Learn learn_;
  motion::Skeleton skeleton_;
  std::vector<std::unique_ptr<ClassModel>> models_;  // [classes]
};

// The trivial method with the follower's first pose: holds that pose still.
class FrozenFirstFrame : public Method {
 public:
  std::string name() const override { return "frozen_first_frame"; }
  absl::Status Train(const dataset::Dataset&, const std::vector<int>&) override {
    return absl::OkStatus();
  }
  absl::StatusOr<motion::Poses> Predict(const dataset::Sequence& sequence) const override {
    const motion::Poses& captured = sequence.pair.follower.poses;
    motion::Poses held(0, captured.joint_count());
    for (int t = 0; t < sequence.pair.leader.frame_count(); ++t) held.Append(captured[0]);
    return held;
  }
  bool reads_first_pose() const override { return true; }
};

struct Entry {
  const char* name;
  Learn learn;  // null: FrozenFirstFrame
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

absl::StatusOr<std::unique_ptr<Method>> MakeBaseline(const std::string& name) {
  for (const Entry& entry : kBaselines) {
    if (name != entry.name) continue;
    if (entry.learn == nullptr) return std::make_unique<FrozenFirstFrame>();
    return std::make_unique<PerClassMethod>(name, entry.learn);
  }
  return absl::InvalidArgumentError(absl::StrCat("method: expected one of ",
                                                 absl::StrJoin(BaselineNames(), ", "), ", got ",
                                                 base::Quoted(name)));
}

absl::StatusOr<std::vector<motion::Poses>> AnswerWithOtherPeople(const dataset::Dataset& dataset,
                                                                 const std::vector<int>& train,
                                                                 const std::vector<int>& test,
                                                                 uint64_t seed) {
  constexpr auto kFirstFrame = motion::StandardOrigin::kFirstFrame;
  base::Random random(seed);
  std::vector<motion::Poses> answers;
  for (const int index : test) {
    const dataset::Sequence& asked = dataset.sequences[static_cast<size_t>(index)];
    const int frames = asked.pair.leader.frame_count();
    const auto candidates = Candidates(dataset, train, asked.interaction_class, frames);
    if (candidates.empty()) {
      return absl::InvalidArgumentError(absl::StrCat(
          "other people: expected at least one training sequence of class ",
          dataset.classes[static_cast<size_t>(asked.interaction_class)], ", got none"));
    }
    const auto drawn = random.Below(static_cast<int64_t>(candidates.size()));
    const dataset::Sequence& other = *candidates[static_cast<size_t>(drawn)];
    const Rows motion = ToRows(BaselineStandardisation(dataset.skeleton, other, kFirstFrame)
                                   .Apply(other.pair.follower.poses));
    answers.push_back(BaselineStandardisation(dataset.skeleton, asked, kFirstFrame)
                          .Invert(FromRows(motion.rows() < frames ? StretchTo(motion, frames)
                                                                  : Rows(motion.topRows(frames)))));
  }
  return answers;
}

}  // namespace duet::evaluation::baselines

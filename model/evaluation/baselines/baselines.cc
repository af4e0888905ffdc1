#include "model/evaluation/baselines/baselines.h"

#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/base/text.h"
#include "model/evaluation/baselines/class_models.h"

namespace duet::evaluation::baselines {
namespace {

using Learn = std::unique_ptr<ClassModel> (*)(const std::vector<StandardPair>& pairs);

// A method that learns one model for each interaction class.
class PerClassMethod : public protocol::Method {
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
class FrozenFirstFrame : public protocol::Method {
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

}  // namespace

std::vector<std::string> BaselineNames() {
  std::vector<std::string> names;
  for (const Entry& entry : kBaselines) names.push_back(entry.name);
  return names;
}

absl::StatusOr<std::unique_ptr<protocol::Method>> MakeBaseline(const std::string& name) {
  for (const Entry& entry : kBaselines) {
    if (name != entry.name) continue;
    if (entry.learn == nullptr) return std::make_unique<FrozenFirstFrame>();
    return std::make_unique<PerClassMethod>(name, entry.learn);
  }
  return absl::InvalidArgumentError(absl::StrCat("method: expected one of ",
                                                 absl::StrJoin(BaselineNames(), ", "), ", got ",
                                                 base::Quoted(name)));
}

}  // namespace duet::evaluation::baselines

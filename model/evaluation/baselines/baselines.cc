#include "model/evaluation/baselines/baselines.h"

#include <algorithm>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/base/text.h"
#include "model/evaluation/baselines/class_models.h"

namespace duet::evaluation::baselines {
namespace {

// The trivial method with the follower's first pose: holds that pose still.
class FrozenFirstFrame : public protocol::Method {
 public:
  std::string name() const override { return "frozen_first_frame"; }
  absl::Status Train(const dataset::Dataset&, const std::vector<int>&) override {
    return absl::OkStatus();
  }
  absl::StatusOr<motion::Poses> Predict(const dataset::Sequence& sequence) const override {
    const motion::Poses& first = sequence.pair.follower.poses;
    motion::Poses still(sequence.pair.leader.frame_count(), first.joint_count());
    for (int t = 0; t < still.frame_count(); ++t) {
      std::copy(first[0].begin(), first[0].end(), still[t].begin());
    }
    return still;
  }
  bool reads_first_pose() const override { return true; }
};

struct Entry {
  const char* name;
  PerClassMethod::Learn learn;  // null: FrozenFirstFrame
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

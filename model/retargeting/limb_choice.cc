#include "model/retargeting/limb_choice.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "absl/strings/match.h"
#include "model/base/index.h"

namespace duet::retargeting {
namespace {

using base::Index;

// What speaks against a choice. A bone in between weighs as much as a ratio of lengths of 1.3.
constexpr double kNotBelow = 100, kNoLength = 50, kBoneBetween = 0.5, kRatio = 2, kHelper = 0.3;
// Of the longer bone.
constexpr double kShortest = 0.05;
// More joints of one name are not compared.
constexpr std::size_t kMostCandidates = 8;

class LimbChooser {
 public:
  LimbChooser(const std::vector<std::string>& names, const JointTree* tree,
              const std::function<double(int, int)>& distance)
      : names_(names), tree_(tree), distance_(distance) {}

  double Cost(const std::array<int, 3>& limb) const {
    const double upper = distance_(limb[0], limb[1]), lower = distance_(limb[1], limb[2]);
    const double shorter = std::min(upper, lower), longer = std::max(upper, lower);
    double cost = CostOfBone(limb[0], limb[1]) + CostOfBone(limb[1], limb[2]);
    cost += shorter > kShortest * longer ? kRatio * std::log(longer / shorter) : kNoLength;
    for (int joint : limb) {
      if (absl::StartsWith(names_[Index(joint)], "_")) cost += kHelper;
    }
    return cost;
  }

 private:
  double CostOfBone(int from, int to) const {
    if (tree_ == nullptr) return 0;
    int bones = 0;
    for (; to > from; to = tree_->parents[Index(to)]) ++bones;
    return to == from && bones > 0 ? kBoneBetween * (bones - 1) : kNotBelow;
  }

  const std::vector<std::string>& names_;
  const JointTree* tree_;
  const std::function<double(int, int)>& distance_;
};

std::vector<int> Few(std::vector<int> joints) {
  if (joints.size() > kMostCandidates) joints.resize(kMostCandidates);
  return joints;
}

}  // namespace

std::array<int, 3> ChooseLimb(const LimbCandidates& candidates,
                              const std::vector<std::string>& names, const JointTree* tree,
                              const std::function<double(int, int)>& distance) {
  const LimbChooser chooser(names, tree, distance);
  std::array<int, 3> best{};
  double least = std::numeric_limits<double>::infinity();
  for (int start : Few(candidates[0])) {
    for (int middle : Few(candidates[1])) {
      for (int end : Few(candidates[2])) {
        const double cost = chooser.Cost({start, middle, end});
        if (!(cost < least)) continue;
        least = cost;
        best = {start, middle, end};
      }
    }
  }
  return best;
}

}  // namespace duet::retargeting

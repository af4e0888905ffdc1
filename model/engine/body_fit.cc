#include "model/engine/body_fit.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

#include "model/base/median.h"
#include "model/base/statistics.h"
#include "model/motion/limb_lengths.h"

namespace duet::engine {
namespace {

constexpr double kClearlyOther = 0.02;  // of the size

}  // namespace

void BodyFit::Add(const motion::Poses& leader, const motion::Poses& follower) {
  const std::vector<float> leaders = MedianBoneLengths(skeleton_, leader),
                           followers = MedianBoneLengths(skeleton_, follower);
  if (std::any_of(leaders.begin(), leaders.end(), [](float length) { return length == 0; })) return;
  for (std::size_t b = 0; b < leaders.size(); ++b) {
    ratios_[b].push_back(double{followers[b]} / double{leaders[b]});
  }
  sizes_.push_back(std::accumulate(followers.begin(), followers.end(), 0.0) /
                   std::accumulate(leaders.begin(), leaders.end(), 0.0));
}

std::vector<double> BodyFit::BoneRatios() const {
  if (sizes_.empty()) return {};
  const bool smaller = base::Quantile(sizes_, 0.9) <= 1 - kClearlyOther,
             larger = base::Quantile(sizes_, 0.1) >= 1 + kClearlyOther;
  std::vector<double> medians;
  if (!smaller && !larger) return medians;
  for (const std::vector<double>& ratios : ratios_) medians.push_back(base::Median(ratios));
  return medians;
}

}  // namespace duet::engine

#include "model/engine/body_fit.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

#include "model/base/median.h"
#include "model/base/statistics.h"
#include "model/motion/limb_lengths.h"
#include "model/solver/stature.h"

namespace duet::engine {
namespace {

constexpr double kClearlyOther = 0.02;  // of the size
constexpr double kFewestSeconds = 10, kFewestSecondsTogether = 30;
constexpr double kMostPairs = 0.95, kLeastPoseSeconds = 0.5;

}  // namespace

BodyFit::BodyFit(const motion::Skeleton& skeleton, double frame_rate_hz)
    : skeleton_(skeleton),
      frame_rate_hz_(frame_rate_hz),
      body_(body::FindBody(skeleton)),
      ratios_(skeleton.bones.size()) {}

void BodyFit::Add(const motion::Poses& leader, const motion::Poses& follower) {
  const std::vector<float> leaders = MedianBoneLengths(skeleton_, leader),
                           followers = MedianBoneLengths(skeleton_, follower);
  if (std::any_of(leaders.begin(), leaders.end(), [](float length) { return length == 0; })) return;
  for (std::size_t b = 0; b < leaders.size(); ++b) {
    ratios_[b].push_back(double{followers[b]} / double{leaders[b]});
  }
  sizes_.push_back(std::accumulate(followers.begin(), followers.end(), 0.0) /
                   std::accumulate(leaders.begin(), leaders.end(), 0.0));
  MeasurePoses(leader, follower);
  if (body_.legs.empty() || follower.frame_count() < kFewestSeconds * frame_rate_hz_) return;
  const std::vector<float> heights =
      solver::LastingHipHeights(body_.legs, follower, frame_rate_hz_);
  heights_.insert(heights_.end(), heights.begin(), heights.end());
}

void BodyFit::MeasurePoses(const motion::Poses& leader, const motion::Poses& follower) {
  body::LongestPoses longest(skeleton_, body_);
  for (int t = 0; t < follower.frame_count(); ++t) longest.Add(leader[t], follower[t]);
  astride_.push_back(longest.Get(frame_rate_hz_).astride);
  held_out_.push_back(longest.Get(frame_rate_hz_).held_out);
  frames_ += follower.frame_count();
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

body::PoseSeconds BodyFit::LongestPoses() const {
  if (frames_ < kFewestSecondsTogether * frame_rate_hz_) return {};
  const auto longest = [](const std::vector<double>& seconds) {
    return std::max(kLeastPoseSeconds, base::Quantile(seconds, kMostPairs));
  };
  return {longest(astride_), longest(held_out_)};
}

double BodyFit::HipHeight() const {
  if (static_cast<double>(heights_.size()) < kFewestSecondsTogether * frame_rate_hz_) return 0;
  return base::Quantile(heights_, 0.1);
}

}  // namespace duet::engine

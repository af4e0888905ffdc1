#include "server/batching/batch_cost.h"

#include <algorithm>
#include <cmath>

namespace duet::server::batching {
namespace {

constexpr double kKept = 0.8;           // weight of earlier batches, for each new one
constexpr double kMostSurprise = 4;     // maximum ratio to the expected seconds
constexpr double kHalfLifeSeconds = 1;  // of an estimate without new batches
// Sizes that vary by less than this fraction of their mean do not determine the cost of a frame.
constexpr double kTellingSpread = 0.1;

}  // namespace

void BatchCost::Observe(int frames, double seconds, common::TimePoint at) {
  const double x = frames;
  const double y = weight_ > 0 ? std::min(seconds, kMostSurprise * Fit().Seconds(frames)) : seconds;
  weight_ = kKept * weight_ + 1;
  x_ = kKept * x_ + x;
  y_ = kKept * y_ + y;
  xx_ = kKept * xx_ + x * x;
  xy_ = kKept * xy_ + x * y;
  last_ = at;
}

CostEstimate BatchCost::At(common::TimePoint now) const {
  if (weight_ == 0) return {};
  const double idle_seconds = std::max(0.0, common::SecondsBetween(last_, now));
  const double trust = std::exp2(-idle_seconds / kHalfLifeSeconds);
  const CostEstimate fit = Fit();
  return {trust * fit.batch_seconds, trust * fit.frame_seconds};
}

CostEstimate BatchCost::Fit() const {
  const double mean_x = x_ / weight_, mean_y = y_ / weight_;
  const double variance = xx_ / weight_ - mean_x * mean_x;
  const double covariance = xy_ / weight_ - mean_x * mean_y;
  const double proportional = mean_y / mean_x;
  // Least squares, regularised towards proportionality if the sizes vary too little.
  const double prior = std::pow(kTellingSpread * mean_x, 2);
  const double slope = (covariance + prior * proportional) / (variance + prior);
  // Both parts are at least 0.
  const double frame_seconds = std::clamp(slope, 0.0, proportional);
  return {mean_y - frame_seconds * mean_x, frame_seconds};
}

}  // namespace duet::server::batching

#include "model/engine/leader_statistics.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "model/engine/leader_features.h"

namespace duet::engine {
namespace {

// Where training leaders are nearer than this to their mean, in deviations, they are too few or too
// alike to tell what is far.
constexpr double kSmallestScale = 0.5;

LeaderStatistics::Feature Fit(const LeaderFeature& feature,
                              const std::vector<std::vector<double>>& leaders, std::size_t index) {
  const auto count = static_cast<double>(leaders.size());
  double mean = 0, square = 0;
  for (const std::vector<double>& values : leaders) mean += values[index] / count;
  for (const std::vector<double>& values : leaders) {
    square += (values[index] - mean) * (values[index] - mean) / count;
  }
  return {std::string(feature.name), mean, std::max(std::sqrt(square), feature.smallest_deviation)};
}

}  // namespace

LeaderStatistics FitLeaderStatistics(const motion::Skeleton& skeleton,
                                     const std::vector<const motion::Poses*>& leaders,
                                     double frame_rate_hz) {
  std::vector<std::vector<double>> values;
  values.reserve(leaders.size());
  for (const motion::Poses* leader : leaders) {
    values.push_back(MeasureLeader(skeleton, *leader, frame_rate_hz));
  }
  LeaderStatistics statistics;
  const std::vector<LeaderFeature> features = LeaderFeatures(skeleton);
  for (std::size_t i = 0; i < features.size(); ++i) {
    statistics.features.push_back(Fit(features[i], values, i));
  }
  std::vector<double> distances;
  distances.reserve(leaders.size());
  for (const motion::Poses* leader : leaders) {
    distances.push_back(Unfamiliarity(statistics, skeleton, *leader, frame_rate_hz));
  }
  statistics.scale = std::max(NinthDecile(std::move(distances)), kSmallestScale);
  return statistics;
}

double Unfamiliarity(const LeaderStatistics& statistics, const motion::Skeleton& skeleton,
                     const motion::Poses& leader, double frame_rate_hz) {
  const std::vector<LeaderFeature> features = LeaderFeatures(skeleton);
  const std::vector<double> values = MeasureLeader(skeleton, leader, frame_rate_hz);
  double square = 0;
  int count = 0;
  for (const LeaderStatistics::Feature& known : statistics.features) {
    for (std::size_t i = 0; i < features.size(); ++i) {
      if (features[i].name != known.name) continue;
      square += std::pow((values[i] - known.mean) / known.deviation, 2);
      ++count;
    }
  }
  return count == 0 ? 0 : std::sqrt(square / count) / statistics.scale;
}

double NinthDecile(std::vector<double> values) {
  const std::size_t rank = (values.size() * 9 + 9) / 10 - 1;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rank),
                   values.end());
  return values[rank];
}

}  // namespace duet::engine

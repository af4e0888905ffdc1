#include "model/evaluation/experiments/live_hour.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "model/body/liveliness.h"
#include "model/body/posture.h"
#include "model/motion/filter.h"
#include "model/motion/resample.h"

namespace duet::evaluation::experiments {
namespace {

constexpr double kEndSeconds = 60;

// Of the two roots along the floor, in each frame.
std::vector<double> Distances(const motion::Skeleton& skeleton, const motion::Poses& leader,
                              const motion::Poses& follower) {
  std::vector<double> distances;
  for (int t = 0; t < follower.frame_count(); ++t) {
    const motion::Vec3 apart = follower.at(t, skeleton.root) - leader.at(t, skeleton.root);
    distances.push_back(std::hypot(apart.x, apart.z));
  }
  return distances;
}

}  // namespace

LiveHourFigures MeasureLiveHour(const motion::Skeleton& skeleton, const motion::Poses& leader,
                                const motion::Poses& follower, double frame_rate_hz) {
  const int part =
      std::min(follower.frame_count(), static_cast<int>(std::lround(kEndSeconds * frame_rate_hz)));
  const auto speed = [&](int first) {
    const motion::Poses end = motion::Part(follower, first, part);
    return body::JointSpeed(motion::WithoutNoise(end, frame_rate_hz), frame_rate_hz);
  };
  int outside = 0, run = 0, longest = 0;
  const std::vector<double> distances = Distances(skeleton, leader, follower);
  for (const double distance : distances) {
    const bool is_outside = distance < kNearestWanted || distance > kFarthestWanted;
    run = is_outside ? run + 1 : 0;
    longest = std::max(longest, run);
    outside += is_outside ? 1 : 0;
  }
  const body::FloorGap gap = body::MeasureFloorGap(follower, skeleton, /*floor=*/0);
  LiveHourFigures figures;
  figures.trunk_lean =
      body::MeasureLean(follower, skeleton, frame_rate_hz, body::LeanFrom::kHips).max_degrees;
  figures.nearest = *std::min_element(distances.begin(), distances.end());
  figures.farthest = *std::max_element(distances.begin(), distances.end());
  figures.out_of_range = static_cast<double>(outside) / follower.frame_count();
  figures.longest_outside = longest / frame_rate_hz;
  figures.feet = std::fmax(gap.above, gap.below);
  figures.first_speed = speed(0);
  figures.last_speed = speed(follower.frame_count() - part);
  return figures;
}

}  // namespace duet::evaluation::experiments

#include "model/evaluation/experiments/live_hour.h"

#include <algorithm>
#include <cmath>

#include "model/evaluation/metrics/liveliness.h"
#include "model/evaluation/metrics/posture.h"
#include "model/motion/filter.h"

namespace duet::evaluation::experiments {
namespace {

using motion::Poses;

constexpr double kEndSeconds = 60;

double SpeedOf(const Poses& poses, int first, int count, double rate) {
  Poses part(0, poses.joint_count());
  part.Append(poses.frames(first, count));
  return metrics::JointSpeed(motion::WithoutNoise(part, rate), rate);
}

void MeasureDistances(const motion::Skeleton& skeleton, const Poses& leader, const Poses& follower,
                      double frame_rate_hz, LiveHourFigures* figures) {
  figures->nearest = HUGE_VAL;
  int outside = 0, run = 0, longest = 0;
  for (int t = 0; t < follower.frame_count(); ++t) {
    const motion::Vec3 apart = follower.at(t, skeleton.root) - leader.at(t, skeleton.root);
    const double distance = std::hypot(apart.x, apart.z);
    figures->nearest = std::min(figures->nearest, distance);
    figures->farthest = std::max(figures->farthest, distance);
    const bool is_outside = distance < kNearestWanted || distance > kFarthestWanted;
    run = is_outside ? run + 1 : 0;
    longest = std::max(longest, run);
    outside += is_outside ? 1 : 0;
  }
  figures->longest_outside = longest / frame_rate_hz;
  figures->out_of_range = static_cast<double>(outside) / follower.frame_count();
}

}  // namespace

LiveHourFigures MeasureLiveHour(const motion::Skeleton& skeleton, const Poses& leader,
                                const Poses& follower, double frame_rate_hz) {
  const int frames = follower.frame_count();
  const int part = std::min(frames, static_cast<int>(std::lround(kEndSeconds * frame_rate_hz)));
  const metrics::FloorGap gap = metrics::MeasureFloorGap(follower, skeleton, /*floor=*/0);
  LiveHourFigures figures;
  figures.trunk_lean =
      MeasureLean(follower, skeleton, frame_rate_hz, metrics::LeanFrom::kHips).max_degrees;
  MeasureDistances(skeleton, leader, follower, frame_rate_hz, &figures);
  figures.feet = std::fmax(gap.above, gap.below);
  figures.first_speed = SpeedOf(follower, 0, part, frame_rate_hz);
  figures.last_speed = SpeedOf(follower, frames - part, part, frame_rate_hz);
  return figures;
}

}  // namespace duet::evaluation::experiments

#include "model/evaluation/experiments/long_clips.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "model/evaluation/metrics/liveliness.h"
#include "model/evaluation/metrics/posture.h"
#include "model/motion/filter.h"

namespace duet::evaluation::experiments {
namespace {

constexpr double kEndSeconds = 10;

double Floor(const motion::Skeleton& skeleton, const motion::Poses& leader) {
  if (!skeleton.feet) return 0;
  std::vector<float> heights;
  for (int t = 0; t < leader.frame_count(); ++t) {
    heights.push_back(
        std::min(leader.at(t, skeleton.feet->left).y, leader.at(t, skeleton.feet->right).y));
  }
  const auto middle = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
  std::nth_element(heights.begin(), middle, heights.end());
  return *middle;
}

double Farthest(const motion::Skeleton& skeleton, const motion::Poses& leader,
                const motion::Poses& follower) {
  double farthest = 0;
  for (int t = 0; t < follower.frame_count(); ++t) {
    const motion::Vec3 apart = follower.at(t, skeleton.root) - leader.at(t, skeleton.root);
    farthest = std::max<double>(farthest, std::hypot(apart.x, apart.z));
  }
  return farthest;
}

motion::Poses Part(const motion::Poses& poses, int first, int count) {
  motion::Poses part(0, poses.joint_count());
  part.Append(poses.frames(first, count));
  return part;
}

}  // namespace

LongClipFigures MeasureLongClip(const motion::Skeleton& skeleton, const motion::Poses& leader,
                                const motion::Poses& follower, double frame_rate_hz) {
  const double floor = Floor(skeleton, leader);
  const motion::Poses calm = motion::WithoutNoise(follower, frame_rate_hz);
  const int frames = calm.frame_count();
  const int part = std::min(frames, static_cast<int>(std::lround(kEndSeconds * frame_rate_hz)));
  const motion::Poses end = Part(follower, frames - part, part);
  const auto lean = [&](const motion::Poses& poses, metrics::LeanFrom from) {
    return MeasureLean(poses, skeleton, frame_rate_hz, from);
  };
  const metrics::FloorGap gap = metrics::MeasureFloorGap(follower, skeleton, floor);
  LongClipFigures figures;
  figures.trunk_lean = lean(follower, metrics::LeanFrom::kHips).max_degrees;
  figures.body_lean = lean(follower, metrics::LeanFrom::kFeet).max_degrees;
  figures.feet_above = gap.above;
  figures.feet_below = gap.below;
  figures.farthest = Farthest(skeleton, leader, follower);
  figures.first_speed = metrics::JointSpeed(Part(calm, 0, part), frame_rate_hz);
  figures.last_speed = metrics::JointSpeed(Part(calm, frames - part, part), frame_rate_hz);
  figures.last_lean = std::fmax(lean(end, metrics::LeanFrom::kHips).mean_degrees,
                                lean(end, metrics::LeanFrom::kFeet).mean_degrees);
  figures.last_feet = metrics::MeasureFloorGap(end, skeleton, floor).mean;
  return figures;
}

LongClipFigures Worst(const std::vector<LongClipRow>& rows) {
  LongClipFigures worst = rows.front().figures;
  for (const LongClipRow& row : rows) {
    const LongClipFigures& figures = row.figures;
    worst.trunk_lean = std::fmax(worst.trunk_lean, figures.trunk_lean);
    worst.body_lean = std::fmax(worst.body_lean, figures.body_lean);
    worst.feet_above = std::fmax(worst.feet_above, figures.feet_above);
    worst.feet_below = std::fmax(worst.feet_below, figures.feet_below);
    worst.farthest = std::fmax(worst.farthest, figures.farthest);
    worst.first_speed = std::fmin(worst.first_speed, figures.first_speed);
    worst.last_speed = std::fmin(worst.last_speed, figures.last_speed);
    worst.last_lean = std::fmax(worst.last_lean, figures.last_lean);
    worst.last_feet = std::fmax(worst.last_feet, figures.last_feet);
  }
  return worst;
}

}  // namespace duet::evaluation::experiments

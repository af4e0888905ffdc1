#include "model/cleanup/live_bounds.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

#include "model/base/angle.h"
#include "model/cleanup/directions.h"
#include "model/cleanup/floor.h"
#include "model/cleanup/trunk_bend.h"
#include "model/motion/feet.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;

// The share of the largest lean up to which a trunk is not corrected.
constexpr float kFreeShare = 0.8f;

float Float(double value) { return static_cast<float>(value); }

// From the middle of the hips.
Vec3 Trunk(const motion::JointPair& hips, int chest, const motion::Poses& poses, int frame) {
  return poses.at(frame, chest) -
         Lerp(poses.at(frame, hips.left), poses.at(frame, hips.right), 0.5f);
}

float LeanOf(Vec3 trunk) { return std::atan2(std::hypot(trunk.x, trunk.z), trunk.y); }

// The mean of the last `count` values, or of all if there are fewer.
double MeanOfLast(const std::vector<double>& values, int count) {
  const std::ptrdiff_t last =
      std::min<std::ptrdiff_t>(count, static_cast<std::ptrdiff_t>(values.size()));
  return std::accumulate(values.end() - last, values.end(), 0.0) / static_cast<double>(last);
}

}  // namespace

LiveBounds::LiveBounds(const motion::Skeleton& skeleton, const LiveBoundOptions& options)
    : skeleton_(skeleton), options_(options), body_(body::FindBody(skeleton)) {}

void LiveBounds::BoundBody(const motion::Poses& leader, const Timing& timing,
                           motion::Poses* follower) const {
  LimitLean(timing, follower);
  LimitDistance(leader, timing, follower);
}

float LiveBounds::AllowedLean(double mean) const {
  const double lasting = std::clamp(
      (mean - options_.easy_degrees) / (options_.lasting_degrees - options_.easy_degrees), 0.0,
      1.0);
  const double allowed =
      options_.bow_degrees + (options_.upright_degrees - options_.bow_degrees) * lasting;
  return Float(base::kRadiansPerDegree * allowed);
}

void LiveBounds::LimitLean(const Timing& timing, motion::Poses* follower) const {
  if (!skeleton_.hips || !body_.chest || body_.legs.empty()) return;
  const int lasting =
      std::max(1, static_cast<int>(std::lround(timing.Frames(options_.lasting_seconds))));
  std::vector<double> leans;  // degrees, of the frames so far
  for (int t = 0; t < follower->frame_count(); ++t) {
    const Vec3 trunk = Trunk(*skeleton_.hips, *body_.chest, *follower, t);
    float lean = LeanOf(trunk);
    if (t >= timing.settled && t > 0) {
      const float most = AllowedLean(MeanOfLast(leans, lasting));
      const float allowed = SoftLimit(lean, most * kFreeShare, most);
      const Vec3 axis = Cross(trunk, Vec3{0, 1, 0});  // rotating about it lifts the trunk
      const float length = Norm(axis);
      if (allowed < lean && length > 0) {
        BendAtHips(skeleton_, body_, axis / length, lean - allowed, (*follower)[t]);
        lean = allowed;
      }
    }
    leans.push_back(double{lean} * base::kDegreesPerRadian);
  }
}

float LiveBounds::AllowedDistance(float distance) const {
  const float near = Float(options_.near_metres);
  if (distance < near) {
    return near - SoftLimit(near - distance, 0, near - Float(options_.nearest_metres));
  }
  return SoftLimit(distance, Float(options_.far_metres), Float(options_.farthest_metres));
}

float LiveBounds::Way(const Timing& timing, int frame) const {
  return Float(options_.fastest_metres_per_second * (frame - timing.settled + 1) /
               timing.frame_rate_hz);
}

void LiveBounds::LimitDistance(const motion::Poses& leader, const Timing& timing,
                               motion::Poses* follower) const {
  Vec3 direction{0, 0, 1};  // from the leader, of the last frame that has one
  for (int t = 0; t < follower->frame_count(); ++t) {
    Vec3 offset = follower->at(t, skeleton_.root) - leader.at(t, skeleton_.root);
    offset.y = 0;
    const float distance = Norm(offset);
    if (distance > kNoOffset) direction = offset / distance;
    if (t < timing.settled) continue;
    const float way = Way(timing, t);
    const Vec3 shift = direction * std::clamp(AllowedDistance(distance) - distance, -way, way);
    for (Vec3& joint : (*follower)[t]) joint += shift;
  }
}

void LiveBounds::BoundFeet(const motion::Poses& leader, const Timing& timing,
                           motion::Poses* follower) const {
  if (!skeleton_.feet) return;
  const float floor = FloorHeight(*skeleton_.feet, leader);
  const std::vector<float> heights = LowerFoot(*skeleton_.feet, *follower);
  for (int t = timing.settled; t < follower->frame_count(); ++t) {
    const float height = heights[static_cast<std::size_t>(t)] - floor;
    const float allowed =
        SoftLimit(std::abs(height), Float(options_.low_metres), Float(options_.lowest_metres));
    // The correction may also undo what the plan itself rises or sinks.
    const float planned =
        std::abs(heights[static_cast<std::size_t>(t)] -
                 heights[static_cast<std::size_t>(std::max(0, timing.settled - 1))]);
    const float way = Way(timing, t) + planned;
    const float lift = std::clamp(std::copysign(allowed, height) - height, -way, way);
    for (Vec3& joint : (*follower)[t]) joint.y += lift;
    if (t > 0) LowerRisingFoot(floor, t, follower);
  }
}

void LiveBounds::LowerRisingFoot(float floor, int frame, motion::Poses* follower) const {
  const float lowest = Float(options_.lowest_metres);
  const auto height = [&](const body::Limb& leg, int t) {
    return follower->at(t, leg.end).y - floor;
  };
  const body::Limb* rising = nullptr;
  for (const body::Limb& leg : body_.legs) {
    const float before = height(leg, frame - 1), now = height(leg, frame);
    if (before + now <= 2 * lowest) return;  // this foot is low between the frames
    if (now > before && (rising == nullptr || now > height(*rising, frame))) rising = &leg;
  }
  if (rising == nullptr) return;
  Vec3 place = follower->at(frame, rising->end);
  place.y = floor + std::max(lowest, 2 * lowest - height(*rising, frame - 1));
  const Vec3 bend = BendOf(*rising, (*follower)[frame]);
  const float length = Norm(bend);
  if (length > 0) ReachBent(*rising, place, bend / length, (*follower)[frame]);
}

}  // namespace duet::cleanup

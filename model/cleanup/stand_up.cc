#include "model/cleanup/stand_up.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "absl/types/span.h"
#include "model/cleanup/low_pass.h"
#include "model/motion/vec3.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;
using Pose = absl::Span<const Vec3>;

constexpr double kLastingSeconds = 0.35;  // deviation of the Gaussian
constexpr double kSmoothSeconds = 0.1;    // of what limits how far a body is raised
constexpr float kLongestReach = 0.99f;    // of a leg, in its length

Vec3 At(Pose pose, int joint) { return pose[static_cast<std::size_t>(joint)]; }

float MeanLength(const body::Body& body, Pose pose) {
  float sum = 0;
  for (const body::Limb& leg : body.legs) sum += LengthOf(leg, pose);
  return sum / static_cast<float>(body.legs.size());
}

float HipHeight(const body::Body& body, Pose pose) {
  float hips = 0, lowest = At(pose, body.legs.front().end).y;
  for (const body::Limb& leg : body.legs) {
    hips += At(pose, leg.upper).y;
    lowest = std::min(lowest, At(pose, leg.end).y);
  }
  const float length = MeanLength(body, pose);
  return length > 0 ? (hips / static_cast<float>(body.legs.size()) - lowest) / length : 1;
}

// How far a body can be raised before a leg no longer reaches its foot.
float Room(const body::Body& body, Pose pose) {
  float room = INFINITY;
  for (const body::Limb& leg : body.legs) {
    const Vec3 way = At(pose, leg.end) - At(pose, leg.upper);
    const float across = std::hypot(way.x, way.z), reach = kLongestReach * LengthOf(leg, pose);
    const float down = across < reach ? std::sqrt(reach * reach - across * across) : 0;
    room = std::min(room, down + way.y);
  }
  return std::max(0.0f, room);
}

// Raises the body above its feet.
void Raise(const body::Body& body, float by, absl::Span<Vec3> pose) {
  struct Foot {
    Vec3 place, bend;
  };
  std::vector<Foot> feet;
  for (const body::Limb& leg : body.legs) feet.push_back({At(pose, leg.end), BendOf(leg, pose)});
  for (Vec3& joint : pose) joint.y += by;
  for (std::size_t i = 0; i < feet.size(); ++i) {
    ReachBent(body.legs[i], feet[i].place, feet[i].bend, pose);
  }
}

}  // namespace

std::vector<float> LastingHipHeights(const body::Body& body, const motion::Poses& poses,
                                     double frame_rate_hz) {
  std::vector<float> heights;
  for (int t = 0; t < poses.frame_count(); ++t) heights.push_back(HipHeight(body, poses[t]));
  return LowPass(heights, kLastingSeconds * frame_rate_hz);
}

void StandUp(const body::Body& body, double least, const Timing& timing, motion::Poses* poses) {
  if (body.legs.empty() || poses->frame_count() == 0) return;
  const std::vector<float> heights = LastingHipHeights(body, *poses, timing.frame_rate_hz);
  // What is missing, as far as the legs reach in the frames around.
  std::vector<float> lacks;
  for (int t = 0; t < poses->frame_count(); ++t) {
    const float lack = static_cast<float>(least) - heights[static_cast<std::size_t>(t)];
    lacks.push_back(
        -std::min(Room(body, (*poses)[t]), std::max(0.0f, lack) * MeanLength(body, (*poses)[t])));
  }
  const double smooth = timing.Frames(kSmoothSeconds);
  const std::vector<float> raised =
      LowPass(MostAround(lacks, static_cast<int>(std::lround(smooth))), smooth);
  for (int t = timing.settled; t < poses->frame_count(); ++t) {
    const float by = -raised[static_cast<std::size_t>(t)] * EaseIn(timing, t);
    if (by > 0) Raise(body, by, (*poses)[t]);
  }
}

}  // namespace duet::cleanup

#include "model/cleanup/upright.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "model/cleanup/low_pass.h"
#include "model/cleanup/trunk_bend.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;

constexpr float kRadiansPerDegree = 0.01745329252f;

Vec3 Middle(const motion::JointPair& pair, const motion::Poses& poses, int frame) {
  return Lerp(poses.at(frame, pair.left), poses.at(frame, pair.right), 0.5f);
}

// The rotation that reduces a lasting lean to the permitted one.
struct Turn {
  Vec3 axis;
  float radians = 0;
};

Turn TurnBack(Vec3 lean, const UprightOptions& options) {
  const Vec3 axis = Cross(lean, Vec3{0, 1, 0});  // rotating about it lifts the trunk
  const float sine = Norm(axis);
  const float angle = std::atan2(sine, lean.y);
  const float allowed =
      SoftLimit(angle, static_cast<float>(options.free_degrees) * kRadiansPerDegree,
                static_cast<float>(options.most_degrees) * kRadiansPerDegree);
  if (sine == 0) return {{1, 0, 0}, 0};
  return {axis / sine, angle - allowed};
}

}  // namespace

std::vector<Vec3> LastingLean(const motion::JointPair& base, int chest, const motion::Poses& poses,
                              double sigma_frames) {
  std::vector<Vec3> trunk;
  trunk.reserve(static_cast<std::size_t>(poses.frame_count()));
  for (int t = 0; t < poses.frame_count(); ++t) {
    trunk.push_back(poses.at(t, chest) - Middle(base, poses, t));
  }
  trunk = LowPass(trunk, sigma_frames);
  for (Vec3& direction : trunk) {
    const float length = Norm(direction);
    direction = length > 0 ? direction / length : Vec3{0, 1, 0};
  }
  return trunk;
}

void SetTrunkUpright(const motion::Skeleton& skeleton, const body::Body& body,
                     const UprightOptions& options, const Timing& timing, motion::Poses* poses) {
  if (!skeleton.hips || !body.chest || body.legs.empty()) return;
  const std::vector<Vec3> lean =
      LastingLean(*skeleton.hips, *body.chest, *poses, timing.Frames(options.sigma_seconds));
  for (int t = timing.settled; t < poses->frame_count(); ++t) {
    Turn turn = TurnBack(lean[static_cast<std::size_t>(t)], options);
    turn.radians *= EaseIn(timing, t);
    if (turn.radians != 0) BendAtHips(skeleton, body, turn.axis, turn.radians, (*poses)[t]);
  }
}

void SetUpright(const motion::Skeleton& skeleton, const body::Body& body,
                const UprightOptions& options, const Timing& timing, motion::Poses* poses) {
  if (!skeleton.feet || !body.chest) return;
  const std::vector<Vec3> lean =
      LastingLean(*skeleton.feet, *body.chest, *poses, timing.Frames(options.sigma_seconds));
  for (int t = timing.settled; t < poses->frame_count(); ++t) {
    const Turn turn = TurnBack(lean[static_cast<std::size_t>(t)], options);
    if (turn.radians == 0) continue;
    const Vec3 pivot = Middle(*skeleton.feet, *poses, t);
    for (Vec3& joint : (*poses)[t]) {
      joint = pivot + RotateAbout(joint - pivot, turn.axis, turn.radians * EaseIn(timing, t));
    }
  }
}

}  // namespace duet::cleanup

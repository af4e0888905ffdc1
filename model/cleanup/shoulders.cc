#include "model/cleanup/shoulders.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "model/cleanup/directions.h"
#include "model/cleanup/pair_line.h"
#include "model/cleanup/turns.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;
using Pose = absl::Span<Vec3>;

// Shoulders that are nearer together than this fraction of a person's, seen along the trunk, do not
// show where the person faces.
constexpr float kUncertain = 0.3f;

Vec3& At(Pose pose, int joint) { return pose[static_cast<std::size_t>(joint)]; }

class Shoulders {
 public:
  Shoulders(const motion::Skeleton& skeleton, const body::Body& body, float width,
            const ShoulderOptions& options)
      : hips_(*skeleton.hips), body_(body), width_(width), options_(options) {
    for (const body::Limb& arm : body.arms) AddArm(arm, &moving_);
    if (body.neck) {
      moving_.insert(moving_.end(), body.neck->branch.begin(), body.neck->branch.end());
    }
  }

  // The direction from the right shoulder to the left one, across the trunk, in every frame.
  std::vector<Vec3> Directions(const motion::Poses& poses) const {
    std::vector<Vec3> directions;
    directions.reserve(static_cast<std::size_t>(poses.frame_count()));
    for (int t = 0; t < poses.frame_count(); ++t) {
      const Vec3 up = Up(poses[t]);
      Vec3 across = Across(poses[t], up);
      if (Norm(across) < kUncertain * width_ && !directions.empty()) {
        across = directions.back() - up * Dot(directions.back(), up);
      }
      const float length = Norm(across);
      directions.push_back(length > kNoDirection ? across / length : Vec3{1, 0, 0});
    }
    return directions;
  }

  // Gives the shoulders of one pose a direction, and limits tilt and width by a share.
  void Set(Vec3 from, Vec3 to, float share, Pose pose) const {
    const Vec3 up = Up(pose);
    if (to != from) Turn(up, SignedAngle(from, to, up), pose);
    TrunkAxes axes{-up, to - up * Dot(to, up), {}};
    const float length = Norm(axes.left);
    if (length < kNoDirection) return;
    axes.left = axes.left / length;
    axes.behind = Cross(axes.left, axes.down);
    const Vec3 across = At(pose, body_.shoulders->left) - At(pose, body_.shoulders->right);
    PairLine line;
    if (Norm(across) > kNoDirection) line = Describe(axes, across);
    PairLine limited = line;
    limited.turn = 0;
    limited.tilt = Within(options_.tilt, line.tilt);
    limited.width = std::clamp(line.width, static_cast<float>(options_.narrowest) * width_,
                               static_cast<float>(options_.widest) * width_);
    const bool narrow = Norm(Across(pose, up)) < kUncertain * width_;
    if (!narrow && limited.tilt == line.tilt && limited.width == line.width) return;
    if (!narrow) limited.turn = line.turn;
    limited.tilt = line.tilt + (limited.tilt - line.tilt) * share;
    limited.width = line.width + (limited.width - line.width) * share;
    Place(axes, limited, pose);
  }

 private:
  static void AddArm(const body::Limb& arm, std::vector<int>* joints) {
    joints->insert(joints->end(), {arm.upper, arm.middle, arm.end});
    joints->insert(joints->end(), arm.beyond.begin(), arm.beyond.end());
  }

  // The direction of the trunk, of length 1.
  Vec3 Up(absl::Span<const Vec3> pose) const {
    const auto at = [&](int joint) { return pose[static_cast<std::size_t>(joint)]; };
    const Vec3 trunk = at(*body_.chest) - Lerp(at(hips_.left), at(hips_.right), 0.5f);
    const float length = Norm(trunk);
    return length > kNoDirection ? trunk / length : Vec3{0, 1, 0};
  }

  Vec3 Across(absl::Span<const Vec3> pose, Vec3 up) const {
    const Vec3 across = pose[static_cast<std::size_t>(body_.shoulders->left)] -
                        pose[static_cast<std::size_t>(body_.shoulders->right)];
    return across - up * Dot(across, up);
  }

  // Turns all above the chest about the trunk.
  void Turn(Vec3 up, float radians, Pose pose) const {
    const Vec3 chest = At(pose, *body_.chest);
    for (const int joint : moving_) {
      At(pose, joint) = chest + RotateAbout(At(pose, joint) - chest, up, radians);
    }
  }

  void Place(const TrunkAxes& axes, const PairLine& line, Pose pose) const {
    const Vec3 chest = At(pose, *body_.chest);
    const Vec3 left = At(pose, body_.shoulders->left), right = At(pose, body_.shoulders->right);
    const PlacedPair placed = PlacePair(axes, line, chest, Lerp(left, right, 0.5f) - chest,
                                        Distance(chest, left), Distance(chest, right));
    for (const body::Limb& arm : body_.arms) {
      const bool is_left = arm.upper == body_.shoulders->left;
      const Vec3 moved = is_left ? placed.left - left : placed.right - right;
      for (const int joint : {arm.upper, arm.middle, arm.end}) At(pose, joint) += moved;
      for (const int joint : arm.beyond) At(pose, joint) += moved;
    }
  }

  const motion::JointPair hips_;
  const body::Body& body_;
  const float width_;
  const ShoulderOptions& options_;
  std::vector<int> moving_;  // joints that turn with the shoulders
};

}  // namespace

void LimitShoulders(const motion::Skeleton& skeleton, const body::Body& body,
                    const motion::Poses& leader, const ShoulderOptions& options,
                    const Timing& timing, motion::Poses* poses) {
  if (!skeleton.hips || !body.chest || !body.shoulders) return;
  const std::vector<int> parents = skeleton.Parents();
  for (const int shoulder : {body.shoulders->left, body.shoulders->right}) {
    if (parents[static_cast<std::size_t>(shoulder)] != *body.chest) return;
  }
  const float width = timing.settled > 0
                          ? MedianWidth(*body.shoulders, *poses, timing.settled)
                          : MedianWidth(*body.shoulders, leader, leader.frame_count());
  if (width < kNoDirection) return;
  const Shoulders shoulders(skeleton, body, width, options);
  const std::vector<Vec3> before = shoulders.Directions(*poses);
  std::vector<Vec3> after = before;
  LimitTurns(timing.settled, MostInAFrame(options.fastest_turn, timing), &after);
  for (int t = timing.settled; t < poses->frame_count(); ++t) {
    const std::size_t at = static_cast<std::size_t>(t);
    shoulders.Set(before[at], after[at], EaseIn(timing, t), (*poses)[t]);
  }
}

}  // namespace duet::cleanup

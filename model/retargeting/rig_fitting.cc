#include "model/retargeting/rig_fitting.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "model/base/angle.h"
#include "model/base/index.h"
#include "model/retargeting/foot_pose.h"

namespace duet::retargeting {
namespace {

using base::Index;

bool IsFoot(const motion::Skeleton& skeleton, int joint) {
  return skeleton.feet && (joint == skeleton.feet->left || joint == skeleton.feet->right);
}

// The rotation on the way from one to another that is at most `most` radians from the first.
Quaternion Towards(Quaternion from, Quaternion to, double most) {
  const double way = Angle(from, to);
  return way <= most ? to : Slerp(from, to, most / way);
}

void KeepSigns(const std::vector<Quaternion>& previous, std::vector<Quaternion>* rotations) {
  for (std::size_t j = 0; j < rotations->size(); ++j) {
    Quaternion& q = (*rotations)[j];
    if (Dot(q, previous[j]) < 0) q = {-q.w, -q.x, -q.y, -q.z};
  }
}

}  // namespace

RigFitter::RigFitter(const motion::Skeleton& skeleton, const Rig& rig, double frame_rate_hz,
                     double ankle_height_on_floor, BoneLengths lengths)
    : rig_(rig),
      ankle_height_(ankle_height_on_floor),
      max_foot_turn_(base::kRadiansPerDegree * kMaxFootSpeed / frame_rate_hz),
      fitter_(rig, frame_rate_hz, lengths) {
  for (const RigJoint& joint : rig.joints) {
    feet_.push_back(joint.kind == RigJoint::Kind::kLeaf && IsFoot(skeleton, joint.joint));
  }
}

const RigPose& RigFitter::Fit(absl::Span<const motion::Vec3> positions) {
  const std::vector<Quaternion> previous = std::move(pose_.rotations);
  pose_ = fitter_.Fit(positions);
  TurnFeet(previous);
  if (!first_) KeepSigns(previous, &pose_.rotations);
  first_ = false;
  return pose_;
}

// The fit leaves feet at rest relative to their shins.
void RigFitter::TurnFeet(const std::vector<Quaternion>& previous) {
  std::vector<Quaternion> world(rig_.joints.size());
  std::vector<Vec3d> at(rig_.joints.size());
  for (std::size_t j = 0; j < rig_.joints.size(); ++j) {
    const int parent = rig_.joints[j].parent;
    const Quaternion above = parent < 0 ? Quaternion{} : world[Index(parent)];
    at[j] = (parent < 0 ? Vec3d{} : at[Index(parent)]) + Rotate(above, pose_.translations[j]);
    if (feet_[j]) {
      const Quaternion foot = Inverse(above) * FootRotation(above, at[j], ankle_height_);
      pose_.rotations[j] = first_ ? foot : Towards(previous[j], foot, max_foot_turn_);
    }
    world[j] = above * pose_.rotations[j];
  }
}

std::vector<Vec3d> JointPositions(const Rig& rig, const RigPose& pose) {
  std::vector<Vec3d> at(rig.joints.size());
  std::vector<Quaternion> world(rig.joints.size());
  for (std::size_t j = 0; j < rig.joints.size(); ++j) {
    const RigJoint& joint = rig.joints[j];
    const bool root = joint.parent < 0;
    at[j] = root ? pose.root_position
                 : at[Index(joint.parent)] + Rotate(world[Index(joint.parent)], joint.offset);
    world[j] = root ? pose.rotations[j] : world[Index(joint.parent)] * pose.rotations[j];
  }
  return at;
}

namespace {

constexpr double kBlockSeconds = 1;

int BlockFrames(double frame_rate_hz) {
  return std::max(1, static_cast<int>(std::lround(kBlockSeconds * frame_rate_hz)));
}

std::vector<Quaternion> WorldRotations(const Rig& rig, const RigPose& pose) {
  std::vector<Quaternion> world;
  for (std::size_t j = 0; j < rig.joints.size(); ++j) {
    const int parent = rig.joints[j].parent;
    const Quaternion local = pose.rotations[j];
    world.push_back(parent < 0 ? local : world[static_cast<std::size_t>(parent)] * local);
  }
  return world;
}

// From `a` (share 0) to `b` (share 1), joint by joint in the world. Both have the same positions.
RigPose Between(const Rig& rig, const RigPose& a, const RigPose& b, double share) {
  const std::vector<Quaternion> world_a = WorldRotations(rig, a), world_b = WorldRotations(rig, b);
  RigPose pose = a;
  std::vector<Quaternion> world;
  for (std::size_t j = 0; j < rig.joints.size(); ++j) {
    const int parent = rig.joints[j].parent;
    world.push_back(Slerp(world_a[j], world_b[j], share));
    pose.rotations[j] =
        parent < 0 ? world[j] : Inverse(world[static_cast<std::size_t>(parent)]) * world[j];
  }
  return pose;
}

}  // namespace

EndlessRigFitter::EndlessRigFitter(const motion::Skeleton& skeleton, const Rig& rig,
                                   double frame_rate_hz, double ankle_height_on_floor)
    : skeleton_(skeleton),
      rig_(rig),
      frame_rate_hz_(frame_rate_hz),
      ankle_height_(ankle_height_on_floor),
      block_(BlockFrames(frame_rate_hz)),
      older_(NewFitter()),
      younger_(NewFitter()) {}

int EndlessRigFitter::HistoryFrames(double frame_rate_hz) { return 2 * BlockFrames(frame_rate_hz); }

std::unique_ptr<RigFitter> EndlessRigFitter::NewFitter() const {
  return std::make_unique<RigFitter>(skeleton_, rig_, frame_rate_hz_, ankle_height_,
                                     BoneLengths::kRigs);
}

const RigPose& EndlessRigFitter::Fit(int frame, absl::Span<const motion::Vec3> positions) {
  const int since = frame % block_;
  if (since == 0) {
    older_ = std::exchange(younger_, NewFitter());
  }
  const RigPose& from = older_->Fit(positions);
  const RigPose& to = younger_->Fit(positions);
  pose_ = Between(rig_, from, to, static_cast<double>(since) / block_);
  return pose_;
}

namespace {

// Metres, and radians.
constexpr double kSamePlace = 2e-5, kNoTurn = 1e-6;

}  // namespace

std::vector<Vec3d> RestPositions(const Rig& rig) {
  std::vector<Vec3d> positions;
  double lowest = 0;
  for (const RigJoint& joint : rig.joints) {
    const Vec3d above = joint.parent < 0 ? Vec3d{} : positions[Index(joint.parent)];
    positions.push_back(above + joint.offset);
    lowest = std::min(lowest, positions.back().y);
  }
  for (Vec3d& position : positions) position.y -= lowest;
  return positions;
}

Vec3d RigAnimation::RestTranslation(std::size_t joint) const {
  const int parent = rig.joints[joint].parent;
  return parent < 0 ? rest_positions[joint] : rig.joints[joint].offset;
}

bool RigAnimation::KeepsItsPlace(std::size_t joint) const {
  const Vec3d rest = RestTranslation(joint);
  return std::all_of(frames.begin(), frames.end(), [joint, rest](const RigPose& pose) {
    return Norm(pose.translations[joint] - rest) < kSamePlace;
  });
}

bool RigAnimation::NeverTurns(std::size_t joint) const {
  return std::all_of(frames.begin(), frames.end(), [joint](const RigPose& pose) {
    return Angle(pose.rotations[joint], {}) < kNoTurn;
  });
}

RigAnimation AnimateRig(const motion::Skeleton& skeleton, const motion::Clip& clip) {
  RigAnimation animation;
  animation.rig = MakeRig(skeleton, clip);
  animation.rest_positions = RestPositions(animation.rig);
  animation.frame_rate_hz = clip.frame_rate_hz;
  const double ankle_height = AnkleHeightOnFloor(skeleton, clip);
  animation.sole_depth = SoleDepth(ankle_height);
  RigFitter fitter(skeleton, animation.rig, clip.frame_rate_hz, ankle_height,
                   BoneLengths::kCaptured);
  for (int frame = 0; frame < clip.frame_count(); ++frame) {
    animation.frames.push_back(fitter.Fit(clip.poses[frame]));
  }
  return animation;
}

}  // namespace duet::retargeting

#include "model/formats/research/placement.h"

#include <algorithm>
#include <cstddef>

#include "model/formats/research/body_joints.h"

namespace duet::formats::research {

using retargeting::Quaternion;
using retargeting::Vec3d;

std::vector<BodyPose> ToDouble(const motion::Clip& body) {
  std::vector<BodyPose> poses;
  for (int frame = 0; frame < body.frame_count(); ++frame) {
    BodyPose pose;
    for (const motion::Vec3& position : body.poses[frame]) {
      pose.push_back(retargeting::ToDouble(position));
    }
    poses.push_back(std::move(pose));
  }
  return poses;
}

motion::Clip ToClip(const std::vector<BodyPose>& poses, double frame_rate_hz) {
  motion::Clip clip;
  clip.joint_names = BodySkeleton().joint_names;
  clip.frame_rate_hz = frame_rate_hz;
  clip.poses = motion::Poses(static_cast<int>(poses.size()), kBodyJoints);
  for (std::size_t frame = 0; frame < poses.size(); ++frame) {
    std::transform(poses[frame].begin(), poses[frame].end(),
                   clip.poses[static_cast<int>(frame)].begin(), retargeting::ToFloat);
  }
  return clip;
}

std::vector<BodyPose> Place(const Placement& placement, const std::vector<BodyPose>& poses) {
  std::vector<BodyPose> placed = poses;
  for (BodyPose& pose : placed) {
    for (Vec3d& position : pose) position = Rotate(placement.turn, position - placement.origin);
  }
  return placed;
}

double FloorOf(const std::vector<BodyPose>& poses) {
  double floor = poses[0][0].y;
  for (const BodyPose& pose : poses) {
    for (const Vec3d& position : pose) floor = std::min(floor, position.y);
  }
  return floor;
}

Vec3d Ahead(Vec3d across) { return retargeting::Unit(Cross({0, 1, 0}, across), {0, 0, 1}); }

Quaternion TurnToZ(Vec3d ahead) { return retargeting::ShortestArc(ahead, {0, 0, 1}, {0, 1, 0}); }

std::array<double, 6> SixNumbers(Quaternion rotation) {
  const Vec3d first = Rotate(rotation, {1, 0, 0}), second = Rotate(rotation, {0, 1, 0});
  return {first.x, first.y, first.z, second.x, second.y, second.z};
}

std::array<bool, 4> FeetStay(const BodyPose& pose, const BodyPose& next, double most_squared) {
  std::array<bool, 4> stay = {};
  const std::array<std::size_t, 4> feet = {kLeftAnkle, kLeftFoot, kRightAnkle, kRightFoot};
  for (std::size_t i = 0; i < feet.size(); ++i) {
    const Vec3d way = next[feet[i]] - pose[feet[i]];
    stay[i] = Dot(way, way) < most_squared;
  }
  return stay;
}

}  // namespace duet::formats::research

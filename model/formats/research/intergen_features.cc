#include "model/formats/research/intergen_features.h"

#include <array>
#include <cstddef>

#include "model/formats/research/body_joints.h"

namespace duet::formats::research {
namespace {

using retargeting::Quaternion;
using retargeting::Vec3d;

constexpr double kFootStays = 0.001;
constexpr std::array<double, 4> kFootHeights = {0.12, 0.05, 0.12, 0.05};
constexpr std::size_t kJoints = kBodyJoints;
// Of a joint's rotation to be its parent's, against its bones: decides the twist of a single bone.
constexpr double kPriorWeight = 1e-3;

// The direction of the bone that ends at a joint, in a T pose that faces z.
Vec3d RestDirection(std::size_t joint) {
  switch (joint) {
    case kLeftHip:
      return retargeting::Unit({0.6, -0.8, 0}, {});
    case kRightHip:
      return retargeting::Unit({-0.6, -0.8, 0}, {});
    case kLeftCollar:
      return retargeting::Unit({0.6, 0.8, 0}, {});
    case kRightCollar:
      return retargeting::Unit({-0.6, 0.8, 0}, {});
    case kLeftShoulder:
    case kLeftElbow:
    case kLeftWrist:
      return {1, 0, 0};
    case kRightShoulder:
    case kRightElbow:
    case kRightWrist:
      return {-1, 0, 0};
    case kLeftFoot:
    case kRightFoot:
      return retargeting::Unit({0, -0.4, 0.9}, {});
    case kLeftKnee:
    case kRightKnee:
    case kLeftAnkle:
    case kRightAnkle:
      return {0, -1, 0};
    default:
      return {0, 1, 0};
  }
}

// The rotations of joints relative to their parents. [kBodyJoints]
std::vector<Quaternion> Rotations(const BodyPose& pose) {
  std::vector<std::vector<retargeting::Correspondence>> bones(kJoints);
  for (std::size_t joint = 1; joint < kJoints; ++joint) {
    const auto parent = static_cast<std::size_t>(BodyParents()[joint]);
    const Vec3d rest = RestDirection(joint);
    bones[parent].push_back({rest, retargeting::Unit(pose[joint] - pose[parent], rest)});
  }
  const Vec3d ahead = Ahead(pose[kRightHip] - pose[kLeftHip]);
  std::vector<Quaternion> world(kJoints), local(kJoints);
  for (std::size_t joint = 0; joint < kJoints; ++joint) {
    const Quaternion parent = joint == 0 ? Inverse(TurnToZ(ahead))
                                         : world[static_cast<std::size_t>(BodyParents()[joint])];
    world[joint] = bones[joint].empty()
                       ? parent
                       : retargeting::FitRotation(bones[joint], {{parent, kPriorWeight}});
    local[joint] = Inverse(parent) * world[joint];
  }
  return local;
}

}  // namespace

std::vector<std::vector<BodyPose>> AtInterGenStart(
    const std::vector<std::vector<BodyPose>>& people) {
  const BodyPose& first = people[0][0];
  Placement placement{first[kPelvis], TurnToZ(Ahead(first[kRightHip] - first[kLeftHip]))};
  std::vector<std::vector<BodyPose>> placed;
  for (const std::vector<BodyPose>& person : people) {
    placement.origin.y = FloorOf(person);
    placed.push_back(Place(placement, person));
  }
  return placed;
}

std::vector<float> InterGenFeatures(const std::vector<BodyPose>& placed) {
  std::vector<float> features;
  features.reserve((placed.size() - 1) * kInterGenWidth);
  const auto add = [&features](double value) { features.push_back(static_cast<float>(value)); };
  const auto add_point = [&add](Vec3d point) {
    for (const double axis : {point.x, point.y, point.z}) add(axis);
  };
  for (std::size_t t = 0; t + 1 < placed.size(); ++t) {
    const BodyPose& pose = placed[t];
    const BodyPose& next = placed[t + 1];
    for (const Vec3d& position : pose) add_point(position);
    for (std::size_t joint = 0; joint < kJoints; ++joint) add_point(next[joint] - pose[joint]);
    const std::vector<Quaternion> rotations = Rotations(pose);
    for (std::size_t joint = 1; joint < kJoints; ++joint) {
      const std::array<double, 6> columns = SixNumbers(rotations[joint]);
      for (const std::size_t i : {0, 3, 1, 4, 2, 5}) add(columns[i]);
    }
    const std::array<bool, 4> stay = FeetStay(pose, next, kFootStays);
    const std::array<double, 4> heights = {pose[kLeftAnkle].y, pose[kLeftFoot].y,
                                           pose[kRightAnkle].y, pose[kRightFoot].y};
    for (std::size_t i = 0; i < stay.size(); ++i) {
      add(stay[i] && heights[i] < kFootHeights[i] ? 1 : 0);
    }
  }
  return features;
}

}  // namespace duet::formats::research

#include "model/formats/research/humanml3d_features.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "model/formats/research/body_joints.h"

namespace duet::formats::research {
namespace {

using retargeting::Quaternion;
using retargeting::Vec3d;

constexpr double kFootStays = 0.002;
constexpr double kSigma = 20;  // frames
constexpr int kRadius = 80;    // of the filter: four sigma
constexpr std::size_t kJoints = kBodyJoints;
constexpr std::size_t kWidth = kHumanMl3dWidth;

const std::vector<std::vector<std::size_t>>& Chains() {
  static const auto* const kChains = new std::vector<std::vector<std::size_t>>{
      {kPelvis, kRightHip, kRightKnee, kRightAnkle, kRightFoot},
      {kPelvis, kLeftHip, kLeftKnee, kLeftAnkle, kLeftFoot},
      {kPelvis, kSpine1, kSpine2, kSpine3, kNeck, kHead},
      {kSpine3, kRightCollar, kRightShoulder, kRightElbow, kRightWrist},
      {kSpine3, kLeftCollar, kLeftShoulder, kLeftElbow, kLeftWrist}};
  return *kChains;
}

// The direction of the bone that ends at a joint in the definition's rest pose.
Vec3d RestDirection(std::size_t joint) {
  switch (joint) {
    case kLeftHip:
    case kLeftCollar:
      return {1, 0, 0};
    case kRightHip:
    case kRightCollar:
      return {-1, 0, 0};
    case kSpine1:
    case kSpine2:
    case kSpine3:
    case kNeck:
      return {0, 1, 0};
    case kLeftFoot:
    case kRightFoot:
    case kHead:
      return {0, 0, 1};
    default:
      return {0, -1, 0};
  }
}

// On the floor, starting at x = z = 0, facing z.
std::vector<BodyPose> AtStart(const std::vector<BodyPose>& poses) {
  const BodyPose& first = poses[0];
  const Vec3d across =
      (first[kRightHip] - first[kLeftHip]) + (first[kRightShoulder] - first[kLeftShoulder]);
  return Place({{first[kPelvis].x, FloorOf(poses), first[kPelvis].z}, TurnToZ(Ahead(across))},
               poses);
}

// Filters along the frames; the first and last frames repeat beyond the ends.
std::vector<Vec3d> Smoothed(const std::vector<Vec3d>& directions) {
  std::vector<double> weights;
  double sum = 0;
  for (int i = -kRadius; i <= kRadius; ++i) {
    weights.push_back(std::exp(-0.5 * i * i / (kSigma * kSigma)));
    sum += weights.back();
  }
  const int frames = static_cast<int>(directions.size());
  std::vector<Vec3d> smoothed(directions.size());
  for (int t = 0; t < frames; ++t) {
    for (int i = -kRadius; i <= kRadius; ++i) {
      const auto from = static_cast<std::size_t>(std::clamp(t + i, 0, frames - 1));
      smoothed[static_cast<std::size_t>(t)] +=
          directions[from] * (weights[static_cast<std::size_t>(i + kRadius)] / sum);
    }
  }
  return smoothed;
}

// The rotation of each frame that takes its heading to z.
std::vector<Quaternion> Headings(const std::vector<BodyPose>& poses) {
  std::vector<Vec3d> ahead;
  for (const BodyPose& pose : poses) {
    // The definition subtracts the hips' direction from the shoulders'.
    const Vec3d across =
        (pose[kRightShoulder] - pose[kLeftShoulder]) - (pose[kRightHip] - pose[kLeftHip]);
    ahead.push_back(Cross({0, 1, 0}, retargeting::Unit(across, {-1, 0, 0})));
  }
  std::vector<Quaternion> headings;
  for (const Vec3d& direction : Smoothed(ahead)) {
    headings.push_back(TurnToZ(retargeting::Unit(direction, {0, 0, 1})));
  }
  return headings;
}

// Half of the angle of a rotation about y, -pi/2 to pi/2.
double HalfTurn(Quaternion turn) {
  const double sine = turn.w < 0 ? -turn.y : turn.y;
  return std::asin(std::clamp(sine, -1.0, 1.0));
}

// The rotation of each joint relative to the one before it in its chain. [kBodyJoints]
std::vector<Quaternion> Rotations(const BodyPose& pose, Quaternion heading) {
  std::vector<Quaternion> local(kJoints);
  for (const std::vector<std::size_t>& chain : Chains()) {
    Quaternion before = heading;
    for (std::size_t i = 1; i < chain.size(); ++i) {
      const Vec3d rest = RestDirection(chain[i]);
      const Vec3d bone = retargeting::Unit(pose[chain[i]] - pose[chain[i - 1]], rest);
      const Vec3d beside = rest.z != 0 ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1};
      const Quaternion rotation = retargeting::ShortestArc(rest, bone, beside);
      local[chain[i]] = Inverse(before) * rotation;
      before = rotation;
    }
  }
  return local;
}

class Row {
 public:
  explicit Row(std::vector<float>* out) : out_(out) {}
  void Add(double value) { out_->push_back(static_cast<float>(value)); }
  void Add(Vec3d value) {
    for (const double axis : {value.x, value.y, value.z}) Add(axis);
  }

 private:
  std::vector<float>* out_;
};

}  // namespace

std::vector<float> HumanMl3dFeatures(const std::vector<BodyPose>& poses) {
  const std::vector<BodyPose> placed = AtStart(poses);
  const std::vector<Quaternion> headings = Headings(placed);
  std::vector<float> features;
  features.reserve((placed.size() - 1) * kWidth);
  Row row(&features);
  for (std::size_t t = 0; t + 1 < placed.size(); ++t) {
    const BodyPose& pose = placed[t];
    const BodyPose& next = placed[t + 1];
    row.Add(HalfTurn(headings[t + 1] * Inverse(headings[t])));
    const Vec3d way = Rotate(headings[t + 1], next[kPelvis] - pose[kPelvis]);
    row.Add(way.x);
    row.Add(way.z);
    row.Add(pose[kPelvis].y);
    const Vec3d below{pose[kPelvis].x, 0, pose[kPelvis].z};
    for (std::size_t joint = 1; joint < kJoints; ++joint) {
      row.Add(Rotate(headings[t], pose[joint] - below));
    }
    const std::vector<Quaternion> rotations = Rotations(pose, headings[t]);
    for (std::size_t joint = 1; joint < kJoints; ++joint) {
      for (const double number : SixNumbers(rotations[joint])) row.Add(number);
    }
    for (std::size_t joint = 0; joint < kJoints; ++joint) {
      row.Add(Rotate(headings[t], next[joint] - pose[joint]));
    }
    for (const bool stays : FeetStay(pose, next, kFootStays)) row.Add(stays ? 1 : 0);
  }
  return features;
}

std::vector<BodyPose> FromHumanMl3dFeatures(absl::Span<const double> features) {
  std::vector<BodyPose> poses;
  double half_heading = 0;
  Vec3d root;
  for (std::size_t at = 0; at + kWidth <= features.size(); at += kWidth) {
    if (at > 0) {
      const double* const before = features.data() + at - kWidth;
      half_heading += before[0];
      const Quaternion back = Inverse(retargeting::AxisAngle({0, 1, 0}, 2 * half_heading));
      root += Rotate(back, {before[1], 0, before[2]});
    }
    const double* const row = features.data() + at;
    const Quaternion back = Inverse(retargeting::AxisAngle({0, 1, 0}, 2 * half_heading));
    BodyPose pose = {{root.x, row[3], root.z}};
    for (std::size_t joint = 1; joint < kJoints; ++joint) {
      const double* const local = row + 4 + 3 * (joint - 1);
      pose.push_back(Rotate(back, {local[0], local[1], local[2]}) + Vec3d{root.x, 0, root.z});
    }
    poses.push_back(std::move(pose));
  }
  return poses;
}

std::vector<BodyPose> KeptByHumanMl3d(const std::vector<BodyPose>& poses) {
  std::vector<BodyPose> placed = AtStart(poses);
  const Quaternion heading = Headings(placed)[0];
  placed.pop_back();
  return Place({{}, heading}, placed);
}

}  // namespace duet::formats::research

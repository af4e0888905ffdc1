#include "tests/support/puppet.h"

#include <algorithm>
#include <cmath>

#include "model/base/angle.h"

namespace duet::test {
namespace {

// Metres. Hips relative to the torso, shoulders and head to the neck; x is for the left side.
constexpr retargeting::Vec3d kHip = {0.1, -0.215, 0};
constexpr retargeting::Vec3d kNeck = {0, 0.216, 0};
constexpr retargeting::Vec3d kShoulder = {0.15, -0.01, 0};
constexpr retargeting::Vec3d kHead = {0, 0.208, 0.035};
constexpr double kThigh = 0.43, kShin = 0.41;
constexpr double kUpperArm = 0.29, kForearm = 0.28;
// Limbs never extend completely: a slight bend keeps the plane of elbow and knee defined.
constexpr double kReach = 0.995;
constexpr double kFold = 1.1;

constexpr retargeting::Vec3d kUp = {0, 1, 0}, kForward = {0, 0, 1};

enum Side { kLeft, kRight };

retargeting::Vec3d OnSide(retargeting::Vec3d left, Side side) {
  return side == kLeft ? left : retargeting::Vec3d{-left.x, left.y, left.z};
}

retargeting::Quaternion Turn(Lean lean) {
  return retargeting::AxisAngle({0, 1, 0}, lean.yaw * base::kRadiansPerDegree) *
         retargeting::AxisAngle({1, 0, 0}, lean.pitch * base::kRadiansPerDegree) *
         retargeting::AxisAngle({0, 0, 1}, -lean.roll * base::kRadiansPerDegree);
}

struct Bones {
  double upper = 0, lower = 0;
};

// The middle and end of a limb of two bones from `start` towards `target`. The middle is on the
// side of `pole`, a unit vector perpendicular to the direction.
//
// Source: law of cosines.
struct LimbPoints {
  retargeting::Vec3d middle, end;
};
LimbPoints Reach(retargeting::Vec3d start, retargeting::Vec3d target, Bones bones,
                 retargeting::Vec3d direction, retargeting::Vec3d pole) {
  const double shortest = std::abs(bones.upper - bones.lower) * kFold + 0.01;
  const double way =
      std::clamp(Norm(target - start), shortest, (bones.upper + bones.lower) * kReach);
  const double cosine =
      (bones.upper * bones.upper + way * way - bones.lower * bones.lower) / (2 * bones.upper * way);
  const double along = bones.upper * cosine;
  const double across = bones.upper * std::sqrt(std::max(0.0, 1 - cosine * cosine));
  return {start + direction * along + pole * across, start + direction * way};
}

// A hanging limb bends towards `hanging_pole`. The shortest arc from hanging to the target rotates
// the bend too: a hand that reaches forwards has its elbow below.
LimbPoints PoseLimb(retargeting::Vec3d start, retargeting::Vec3d target, Bones bones,
                    retargeting::Quaternion body, retargeting::Vec3d hanging_pole, double swivel) {
  const retargeting::Vec3d down = Rotate(body, -kUp);
  const retargeting::Vec3d direction = Unit(target - start, down);
  const retargeting::Vec3d hinge = Cross(hanging_pole, -kUp);
  const retargeting::Quaternion swing = ShortestArc(down, direction, Rotate(body, hinge));
  const retargeting::Vec3d pole = Rotate(AxisAngle(direction, swivel * base::kRadiansPerDegree),
                                         Rotate(swing, Rotate(body, hanging_pole)));
  return Reach(start, target, bones, direction, pole);
}

// Outward rotations of the two sides have opposite signs.
double Outwards(double swivel, Side side) { return side == kLeft ? swivel : -swivel; }

class Poser {
 public:
  explicit Poser(const PuppetPose& pose)
      : pose_(pose), pelvis_(Turn(pose.pelvis)), chest_(Turn(pose.chest)), joints_(15) {}

  std::vector<motion::Vec3> Pose() {
    const retargeting::Vec3d neck = pose_.torso + Rotate(chest_, kNeck);
    Set(0, neck + Rotate(Turn(pose_.head), kHead));
    Set(1, neck);
    Set(2, pose_.torso);
    PoseArm(3, neck, pose_.left_hand, kLeft);
    PoseArm(6, neck, pose_.right_hand, kRight);
    PoseLeg(9, pose_.left_foot, kLeft);
    PoseLeg(12, pose_.right_foot, kRight);
    return joints_;
  }

 private:
  void Set(std::size_t joint, retargeting::Vec3d position) { joints_[joint] = ToFloat(position); }

  void SetLimb(std::size_t first, retargeting::Vec3d start, const LimbPoints& points) {
    Set(first, start);
    Set(first + 1, points.middle);
    Set(first + 2, points.end);
  }

  void PoseArm(std::size_t first, retargeting::Vec3d neck, const PuppetPose::Limb& hand,
               Side side) {
    const retargeting::Vec3d shoulder = neck + Rotate(chest_, OnSide(kShoulder, side));
    SetLimb(first, shoulder,
            PoseLimb(shoulder, neck + hand.target, {kUpperArm, kForearm}, chest_, -kForward,
                     Outwards(hand.swivel, side)));
  }

  void PoseLeg(std::size_t first, const PuppetPose::Limb& foot, Side side) {
    const retargeting::Vec3d hip = pose_.torso + Rotate(pelvis_, OnSide(kHip, side));
    SetLimb(first, hip,
            PoseLimb(hip, foot.target, {kThigh, kShin}, pelvis_, kForward,
                     Outwards(-foot.swivel, side)));
  }

  const PuppetPose& pose_;
  retargeting::Quaternion pelvis_, chest_;
  std::vector<motion::Vec3> joints_;
};

}  // namespace

std::vector<motion::Vec3> PosePuppet(const PuppetPose& pose) { return Poser(pose).Pose(); }

}  // namespace duet::test

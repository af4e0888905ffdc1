#include "model/retargeting/mannequin.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/string_view.h"
#include "model/retargeting/mesh_builder.h"

namespace duet::retargeting {
namespace {

constexpr double kSlenderRadius = 0.035;
// Bones of a stick figure: ratio of radius to length, and the minimum radius in metres.
constexpr double kStickShare = 0.12, kThinnestStick = 0.004;
// Half the height of a foot, metres.
constexpr double kThinnestSole = 0.015, kThickestSole = 0.05;
// Bones are slightly thinner than the balls at their ends.
constexpr double kBoneShare = 0.94;
constexpr Fineness kBall = {10, 6}, kPart = {18, 12};

// Radii in metres by a part of the joint's name. Other joints are slender.
double Radius(absl::string_view name) {
  static constexpr struct {
    const char* part;
    double radius;
  } kRadii[] = {{"head", 0.05},   {"neck", 0.047},  {"shoulder", 0.052}, {"clavicle", 0.052},
                {"elbow", 0.041}, {"hand", 0.036},  {"wrist", 0.036},    {"torso", 0.066},
                {"spine", 0.066}, {"chest", 0.066}, {"hip", 0.072},      {"pelvis", 0.072},
                {"root", 0.072},  {"knee", 0.054},  {"foot", 0.043},     {"ankle", 0.043},
                {"toe", 0.043}};
  for (const auto& row : kRadii) {
    if (absl::StrContains(name, row.part)) return row.radius;
  }
  return kSlenderRadius;
}

class MannequinMaker {
 public:
  MannequinMaker(const motion::Skeleton& skeleton, const Rig& rig, const std::vector<Vec3d>& rest,
                 double sole_depth)
      : skeleton_(skeleton), rig_(rig), rest_(rest), sole_depth_(sole_depth) {}

  Mannequin Make() {
    for (std::size_t j = 0; j < rig_.joints.size(); ++j) AddBoneAndBall(static_cast<int>(j));
    AddTrunk();
    AddHead();
    for (const char* side : {"left", "right"}) {
      AddHand(std::string(side) + "_hand");
      AddFoot(std::string(side) + "_foot");
    }
    return std::move(mannequin_);
  }

 private:
  const std::string& NameOf(int rig_joint) const {
    const RigJoint& joint = rig_.joints[static_cast<std::size_t>(rig_joint)];
    return skeleton_.joint_names[static_cast<std::size_t>(joint.joint)];
  }
  Vec3d At(int rig_joint) const { return rest_[static_cast<std::size_t>(rig_joint)]; }

  // The rig joint with a name, or -1.
  int Find(absl::string_view name) const {
    for (std::size_t j = 0; j < rig_.joints.size(); ++j) {
      if (rig_.joints[j].name == name) return static_cast<int>(j);
    }
    return -1;
  }

  // The rig joint at the position of the skeleton's joint `aim`.
  int JointOf(int joint) const {
    for (std::size_t j = 0; j < rig_.joints.size(); ++j) {
      if (rig_.joints[j].joint == joint) return static_cast<int>(j);
    }
    return 0;
  }

  void AddBoneAndBall(int j) {
    MeshBuilder body(&mannequin_.body);
    const RigJoint& joint = rig_.joints[static_cast<std::size_t>(j)];
    const double radius = RadiusOf(j);
    // The joint at a helper's position already has a ball.
    if (joint.name == NameOf(j)) body.AddEllipsoid(At(j), {radius, radius, radius}, j, kBall);
    if (joint.kind != RigJoint::Kind::kAim) return;
    const int child = JointOf(joint.aim);
    body.AddLimb(At(j), At(child), radius * kBoneShare, Radius(NameOf(child)) * kBoneShare, j);
  }

  // The ball of an ankle must not intersect the floor.
  double RadiusOf(int j) const {
    const double radius = Radius(NameOf(j));
    const bool foot = absl::EndsWith(NameOf(j), "_foot");
    return foot ? std::min(radius, std::max(sole_depth_, kThinnestSole)) : radius;
  }

  // Adds ellipsoids around the trunk; its joints determine their widths.
  void AddTrunk() {
    const int torso = Find("torso"), neck = Find("neck"), chest = Find("torso_to_neck");
    const int left_shoulder = Find("left_shoulder"), right_shoulder = Find("right_shoulder");
    const int left_hip = Find("left_hip"), right_hip = Find("right_hip");
    MeshBuilder body(&mannequin_.body);
    if (torso >= 0 && neck >= 0 && chest >= 0 && left_shoulder >= 0 && right_shoulder >= 0) {
      const Vec3d shoulders = (At(left_shoulder) + At(right_shoulder)) * 0.5;
      const double breadth = Norm(At(left_shoulder) - At(right_shoulder));
      const double height = Norm(At(neck) - At(torso));
      body.AddEllipsoid(shoulders * 0.58 + At(torso) * 0.42, {breadth * 0.47, height * 0.66, 0.105},
                        chest, kPart);
    }
    if (torso >= 0 && left_hip >= 0 && right_hip >= 0) {
      const Vec3d hips = (At(left_hip) + At(right_hip)) * 0.5;
      const double breadth = Norm(At(left_hip) - At(right_hip)), height = Norm(At(torso) - hips);
      body.AddEllipsoid(hips * 0.84 + At(torso) * 0.16, {breadth * 0.5 + 0.062, 0.12, 0.1}, torso,
                        kPart);
      body.AddEllipsoid(hips * 0.38 + At(torso) * 0.62,
                        {breadth * 0.34 + 0.05, height * 0.75 + 0.02, 0.088}, torso, kPart);
    }
  }

  void AddHead() {
    const int head = Find("head");
    if (head < 0) return;
    MeshBuilder(&mannequin_.body).AddEllipsoid(At(head), {0.088, 0.118, 0.102}, head, kPart);
    MeshBuilder(&mannequin_.visor)
        .AddEllipsoid(At(head) + Vec3d{0, 0.014, 0.036}, {0.074, 0.042, 0.074}, head, kPart);
  }

  // Adds a hand that is stretched out to the side, palm down.
  void AddHand(const std::string& name) {
    const int hand = Find(name);
    if (hand < 0) return;
    const Vec3d way = Unit(rig_.joints[static_cast<std::size_t>(hand)].end_offset, {0, -1, 0});
    const Vec3d half = {0.02 + 0.065 * std::abs(way.x), 0.02 + 0.065 * std::abs(way.y), 0.042};
    MeshBuilder(&mannequin_.body).AddEllipsoid(At(hand) + way * 0.06, half, hand, kBall);
  }

  void AddFoot(const std::string& name) {
    const int foot = Find(name);
    if (foot < 0) return;
    MeshBuilder body(&mannequin_.body);
    const double half = std::clamp(sole_depth_ / 2, kThinnestSole, kThickestSole);
    body.AddEllipsoid(At(foot) + Vec3d{0, half - sole_depth_, 0.07}, {0.046, half, 0.13}, foot,
                      kPart);
  }

  const motion::Skeleton& skeleton_;
  const Rig& rig_;
  const std::vector<Vec3d>& rest_;
  double sole_depth_;
  Mannequin mannequin_;
};

}  // namespace

Mannequin MakeMannequin(const motion::Skeleton& skeleton, const Rig& rig,
                        const std::vector<Vec3d>& rest_positions, double sole_depth) {
  return MannequinMaker(skeleton, rig, rest_positions, sole_depth).Make();
}

SkinnedMesh MakeStickFigure(const CharacterRig& rig) {
  SkinnedMesh mesh;
  MeshBuilder body(&mesh);
  for (std::size_t j = 0; j < rig.names.size(); ++j) {
    const int joint = static_cast<int>(j), parent = rig.parents[j];
    if (parent < 0) continue;
    const Vec3d from = rig.positions[static_cast<std::size_t>(parent)], to = rig.positions[j];
    // In proportion to the bone: fingers are thinner than thighs.
    const double radius = std::clamp(kStickShare * Norm(to - from), kThinnestStick, kSlenderRadius);
    body.AddLimb(from, to, radius, radius, parent);
    body.AddEllipsoid(to, {radius, radius, radius}, joint, kBall);
  }
  return mesh;
}

}  // namespace duet::retargeting

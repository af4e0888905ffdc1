#include "model/retargeting/mannequin.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/string_view.h"
#include "model/base/angle.h"

namespace duet::retargeting {
namespace {

using base::kPi;
constexpr int kAroundLimb = 12;

// The number of divisions of an ellipsoid: around, and from pole to pole.
struct Fineness {
  int around = 10, stacks = 6;
};

// Adds surfaces of revolution to a mesh. Units: metres.
class MeshBuilder {
 public:
  // `mesh` must outlive the builder.
  explicit MeshBuilder(SkinnedMesh* mesh) : mesh_(*mesh) {}

  // Adds an ellipsoid with half axes along x, y and z.
  void AddEllipsoid(Vec3d centre, Vec3d half, int joint, Fineness fineness) {
    const auto add = [&](Vec3d on_sphere) {
      const Vec3d normal = {on_sphere.x / half.x, on_sphere.y / half.y, on_sphere.z / half.z};
      AddVertex(centre + Vec3d{on_sphere.x * half.x, on_sphere.y * half.y, on_sphere.z * half.z},
                Unit(normal, {0, 1, 0}), joint);
    };
    const uint32_t top = Count();
    add({0, 1, 0});
    for (int stack = 1; stack < fineness.stacks; ++stack) {
      const double polar = kPi * stack / fineness.stacks;
      for (int k = 0; k < fineness.around; ++k) {
        const double turn = 2 * kPi * k / fineness.around;
        add({std::sin(polar) * std::sin(turn), std::cos(polar), std::sin(polar) * std::cos(turn)});
      }
    }
    add({0, -1, 0});
    const auto around = static_cast<uint32_t>(fineness.around);
    const auto stacks = static_cast<uint32_t>(fineness.stacks);
    const uint32_t last_ring = top + 1 + (stacks - 2) * around, bottom = Count() - 1;
    for (uint32_t k = 0; k < around; ++k) {
      const uint32_t next = (k + 1) % around;
      AddTriangle(top, top + 1 + k, top + 1 + next);
      AddTriangle(bottom, last_ring + next, last_ring + k);
    }
    for (uint32_t ring = top + 1; ring < last_ring; ring += around) AddBand(ring, around);
  }

  // Adds an open, tapered tube.
  void AddLimb(Vec3d from, Vec3d to, double radius_from, double radius_to, int joint) {
    const Vec3d along = Unit(to - from, {0, 1, 0});
    const Vec3d side =
        Unit(Cross(along, std::abs(along.y) < 0.9 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0}), {0, 0, 1});
    const Vec3d other = Cross(along, side);
    const double slope = (radius_from - radius_to) / std::max(Norm(to - from), 1e-6);
    const uint32_t first = Count();
    for (const bool far : {true, false}) {
      for (int k = 0; k < kAroundLimb; ++k) {
        const double turn = 2 * kPi * k / kAroundLimb;
        const Vec3d outwards = side * std::cos(turn) + other * std::sin(turn);
        AddVertex((far ? to : from) + outwards * (far ? radius_to : radius_from),
                  Unit(outwards + along * slope, outwards), joint);
      }
    }
    AddBand(first, static_cast<uint32_t>(kAroundLimb));
  }

 private:
  uint32_t Count() const { return static_cast<uint32_t>(mesh_.positions.size()); }

  void AddVertex(Vec3d position, Vec3d normal, int joint) {
    mesh_.positions.push_back(position);
    mesh_.normals.push_back(normal);
    mesh_.joints.push_back(joint);
  }

  void AddTriangle(uint32_t a, uint32_t b, uint32_t c) {
    mesh_.indices.insert(mesh_.indices.end(), {a, b, c});
  }

  // Adds the triangles between the ring that begins at vertex `ring` and the next one.
  void AddBand(uint32_t ring, uint32_t around) {
    for (uint32_t k = 0; k < around; ++k) {
      const uint32_t next = (k + 1) % around;
      AddTriangle(ring + k, ring + around + k, ring + around + next);
      AddTriangle(ring + k, ring + around + next, ring + next);
    }
  }

  SkinnedMesh& mesh_;
};

constexpr double kSlenderRadius = 0.035;
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

}  // namespace duet::retargeting

#include "model/retargeting/mesh_builder.h"

#include <algorithm>
#include <cmath>

#include "model/base/angle.h"

namespace duet::retargeting {
namespace {

using base::kPi;
constexpr int kAroundLimb = 12;

}  // namespace

void MeshBuilder::AddEllipsoid(Vec3d centre, Vec3d half, int joint, Fineness fineness) {
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

void MeshBuilder::AddLimb(Vec3d from, Vec3d to, double radius_from, double radius_to, int joint) {
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

void MeshBuilder::AddVertex(Vec3d position, Vec3d normal, int joint) {
  mesh_.positions.push_back(position);
  mesh_.normals.push_back(normal);
  mesh_.joints.push_back(joint);
}

void MeshBuilder::AddTriangle(uint32_t a, uint32_t b, uint32_t c) {
  mesh_.indices.insert(mesh_.indices.end(), {a, b, c});
}

void MeshBuilder::AddBand(uint32_t ring, uint32_t around) {
  for (uint32_t k = 0; k < around; ++k) {
    const uint32_t next = (k + 1) % around;
    AddTriangle(ring + k, ring + around + k, ring + around + next);
    AddTriangle(ring + k, ring + around + next, ring + next);
  }
}

}  // namespace duet::retargeting

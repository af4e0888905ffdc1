#include "model/motion/coordinates.h"

namespace duet::motion {
namespace {

// The data set's own conversion to millimetres, in metres.
constexpr float kSbuOffsetX = 1.28f, kSbuScaleX = -2.56f;
constexpr float kSbuOffsetY = 0.96f, kSbuScaleY = -1.92f;
constexpr float kSbuScaleZ = 1.28f;
constexpr float kMillimetre = 0.001f;

// Rotations about x: handedness is kept.
Vec3 ToYUp(UpAxis up_axis, Vec3 p) {
  switch (up_axis) {
    case UpAxis::kYUp:
      return p;
    case UpAxis::kZUp:
      return {p.x, p.z, -p.y};
    case UpAxis::kYDown:
      return {p.x, -p.y, -p.z};
  }
  return p;
}

Vec3 FromYUp(UpAxis up_axis, Vec3 p) {
  switch (up_axis) {
    case UpAxis::kYUp:
      return p;
    case UpAxis::kZUp:
      return {p.x, -p.z, p.y};
    case UpAxis::kYDown:
      return {p.x, -p.y, -p.z};
  }
  return p;
}

}  // namespace

Vec3 ToWorld(const Coordinates& coordinates, Vec3 p) {
  switch (coordinates.unit) {
    case LengthUnit::kMetres:
      return ToYUp(coordinates.up_axis, p);
    case LengthUnit::kMillimetres:
      return ToYUp(coordinates.up_axis, p * kMillimetre);
    case LengthUnit::kSbuNormalised:
      return {kSbuOffsetX + kSbuScaleX * p.x, kSbuOffsetY + kSbuScaleY * p.y, kSbuScaleZ * p.z};
  }
  return p;
}

Vec3 FromWorld(const Coordinates& coordinates, Vec3 p) {
  switch (coordinates.unit) {
    case LengthUnit::kMetres:
      return FromYUp(coordinates.up_axis, p);
    case LengthUnit::kMillimetres:
      return FromYUp(coordinates.up_axis, p) / kMillimetre;
    case LengthUnit::kSbuNormalised:
      return {(p.x - kSbuOffsetX) / kSbuScaleX, (p.y - kSbuOffsetY) / kSbuScaleY, p.z / kSbuScaleZ};
  }
  return p;
}

}  // namespace duet::motion

#include "model/motion/coordinates.h"

#include <cstddef>

namespace duet::motion {
namespace {

// The names of the enumerators, in their order.
constexpr absl::string_view kUnits[] = {"metres", "millimetres", "sbu-normalised"};
constexpr absl::string_view kAxes[] = {"y-up", "z-up", "y-down"};

template <typename Value, std::size_t size>
std::optional<Value> ValueOf(const absl::string_view (&names)[size], absl::string_view name) {
  for (std::size_t i = 0; i < size; ++i) {
    if (names[i] == name) return static_cast<Value>(i);
  }
  return std::nullopt;
}

// The data set's documented conversion to millimetres, here in metres.
constexpr float kSbuOffsetX = 1.28f, kSbuScaleX = -2.56f;
constexpr float kSbuOffsetY = 0.96f, kSbuScaleY = -1.92f;
constexpr float kSbuScaleZ = 1.28f;
constexpr float kMillimetre = 0.001f;

// Rotations about x, which keep the handedness.
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

std::optional<Coordinates> StatedCoordinates(const std::optional<LengthUnit>& unit,
                                             const std::optional<UpAxis>& up_axis) {
  if (!unit.has_value() && !up_axis.has_value()) return std::nullopt;
  Coordinates coordinates;
  coordinates.unit = unit.value_or(LengthUnit::kMetres);
  const bool sbu = coordinates.unit == LengthUnit::kSbuNormalised;
  coordinates.up_axis = up_axis.value_or(sbu ? UpAxis::kYDown : UpAxis::kYUp);
  return coordinates;
}

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

absl::string_view LengthUnitName(LengthUnit unit) { return kUnits[static_cast<size_t>(unit)]; }
absl::string_view UpAxisName(UpAxis axis) { return kAxes[static_cast<size_t>(axis)]; }

std::optional<LengthUnit> ParseLengthUnit(absl::string_view name) {
  return ValueOf<LengthUnit>(kUnits, name);
}
std::optional<UpAxis> ParseUpAxis(absl::string_view name) {
  if (name == "y") return UpAxis::kYUp;
  if (name == "z") return UpAxis::kZUp;
  if (name == "-y") return UpAxis::kYDown;
  return ValueOf<UpAxis>(kAxes, name);
}

}  // namespace duet::motion

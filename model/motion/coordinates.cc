#include "model/motion/coordinates.h"

#include <cstddef>

namespace duet::motion {
namespace {

template <typename Value>
struct Spelling {
  absl::string_view name;
  Value value;
};

// The first spelling of a value is its name.
constexpr Spelling<LengthUnit> kUnitSpellings[] = {
    {"metres", LengthUnit::kMetres},
    {"millimetres", LengthUnit::kMillimetres},
    {"sbu-normalised", LengthUnit::kSbuNormalised},
    {"m", LengthUnit::kMetres},
    {"mm", LengthUnit::kMillimetres},
    {"sbu", LengthUnit::kSbuNormalised},
    {"sbu_normalised", LengthUnit::kSbuNormalised},
};
constexpr Spelling<UpAxis> kAxisSpellings[] = {
    {"y-up", UpAxis::kYUp}, {"z-up", UpAxis::kZUp}, {"y-down", UpAxis::kYDown},
    {"y", UpAxis::kYUp},    {"z", UpAxis::kZUp},    {"-y", UpAxis::kYDown},
    {"y_up", UpAxis::kYUp}, {"z_up", UpAxis::kZUp}, {"y_down", UpAxis::kYDown},
};

template <typename Value, std::size_t size>
absl::string_view NameOf(const Spelling<Value> (&spellings)[size], Value value) {
  for (const Spelling<Value>& spelling : spellings) {
    if (spelling.value == value) return spelling.name;
  }
  return {};
}

template <typename Value, std::size_t size>
std::optional<Value> ValueOf(const Spelling<Value> (&spellings)[size], absl::string_view name) {
  for (const Spelling<Value>& spelling : spellings) {
    if (spelling.name == name) return spelling.value;
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

absl::string_view LengthUnitName(LengthUnit unit) { return NameOf(kUnitSpellings, unit); }
absl::string_view UpAxisName(UpAxis axis) { return NameOf(kAxisSpellings, axis); }

std::optional<LengthUnit> ParseLengthUnit(absl::string_view name) {
  return ValueOf(kUnitSpellings, name);
}
std::optional<UpAxis> ParseUpAxis(absl::string_view name) { return ValueOf(kAxisSpellings, name); }

}  // namespace duet::motion

#ifndef DUET_MODEL_MOTION_COORDINATES_H_
#define DUET_MODEL_MOTION_COORDINATES_H_

#include <optional>

#include "absl/strings/string_view.h"
#include "model/motion/vec3.h"

namespace duet::motion {

enum class LengthUnit { kMetres, kMillimetres, kSbuNormalised };
enum class UpAxis { kYUp, kZUp, kYDown };

// The coordinates of a file or a caller. Every combination is right-handed.
//
// kSbuNormalised is the anisotropic unit of the SBU Kinect Interaction data set
// (X = 1.28 - 2.56 x, Y = 0.96 - 1.92 y, Z = 1.28 z metres); it implies kYDown.
struct Coordinates {
  LengthUnit unit = LengthUnit::kMetres;
  UpAxis up_axis = UpAxis::kYUp;
};

// The coordinates that a caller specifies for a file; absent if it specifies neither. The default
// unit is metres; the default axis is the one that the unit implies.
std::optional<Coordinates> StatedCoordinates(const std::optional<LengthUnit>& unit,
                                             const std::optional<UpAxis>& up_axis);

// The metres in one unit of a file, as a caller states them: directly, or else by the unit's name.
// Absent if neither does, or for SBU's unit, which is no mere scale.
inline std::optional<double> StatedMetresPerUnit(const std::optional<double>& metres_per_unit,
                                                 const std::optional<LengthUnit>& unit) {
  if (metres_per_unit.has_value()) return metres_per_unit;
  if (unit == LengthUnit::kMetres) return 1;
  if (unit == LengthUnit::kMillimetres) return 0.001;
  return std::nullopt;
}

// Converts to and from metres, y up. The two are exact inverses up to rounding.
Vec3 ToWorld(const Coordinates& coordinates, Vec3 position);
Vec3 FromWorld(const Coordinates& coordinates, Vec3 position);

// The names of units and axes in flags and files.
absl::string_view LengthUnitName(LengthUnit unit);
absl::string_view UpAxisName(UpAxis axis);
inline constexpr char kLengthUnitNames[] = "metres, millimetres or sbu-normalised";
inline constexpr char kUpAxisNames[] = "y-up, z-up or y-down";

// Absent for an unknown name.
std::optional<LengthUnit> ParseLengthUnit(absl::string_view name);
std::optional<UpAxis> ParseUpAxis(absl::string_view name);

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_COORDINATES_H_

#ifndef DUET_MODEL_MOTION_COORDINATES_H_
#define DUET_MODEL_MOTION_COORDINATES_H_

#include <optional>

#include "absl/strings/string_view.h"
#include "model/motion/vec3.h"

namespace duet::motion {

enum class LengthUnit { kMetres, kMillimetres, kSbuNormalised };
enum class UpAxis { kYUp, kZUp, kYDown };

// How a file or a caller writes positions. Every combination is right-handed.
//
// kSbuNormalised is the anisotropic unit of the SBU Kinect Interaction data set
// (X = 1.28 - 2.56 x, Y = 0.96 - 1.92 y, Z = 1.28 z metres); it implies kYDown.
struct Coordinates {
  LengthUnit unit = LengthUnit::kMetres;
  UpAxis up_axis = UpAxis::kYUp;
};

// What is said of a file beside it: nothing where neither is; the unit metres, the axis what the
// unit implies.
std::optional<Coordinates> StatedCoordinates(const std::optional<LengthUnit>& unit,
                                             const std::optional<UpAxis>& up_axis);

// From the caller's coordinates to metres, y up; and back. Exact inverses up to rounding.
Vec3 ToWorld(const Coordinates& coordinates, Vec3 position);
Vec3 FromWorld(const Coordinates& coordinates, Vec3 position);

// The one spelling of units and axes, in flags and files alike.
absl::string_view LengthUnitName(LengthUnit unit);
absl::string_view UpAxisName(UpAxis axis);
inline constexpr char kLengthUnitNames[] = "metres, millimetres or sbu-normalised";
inline constexpr char kUpAxisNames[] = "y-up, z-up or y-down";

// Nothing for an unknown name. What earlier versions wrote stays readable: "m", "mm", "sbu",
// "sbu_normalised"; "y", "z", "-y", "y_up", "z_up", "y_down".
std::optional<LengthUnit> ParseLengthUnit(absl::string_view name);
std::optional<UpAxis> ParseUpAxis(absl::string_view name);

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_COORDINATES_H_

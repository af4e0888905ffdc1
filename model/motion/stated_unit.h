#ifndef DUET_MODEL_MOTION_STATED_UNIT_H_
#define DUET_MODEL_MOTION_STATED_UNIT_H_

#include <optional>

#include "model/motion/coordinates.h"

namespace duet::motion {

// The metres in one unit of a file, as a caller states them: directly, or else by the unit's name.
// Absent if neither does, or for SBU's unit, which is no mere scale.
inline std::optional<double> StatedMetresPerUnit(const std::optional<double>& metres_per_unit,
                                                 const std::optional<LengthUnit>& unit) {
  if (metres_per_unit.has_value()) return metres_per_unit;
  if (unit == LengthUnit::kMetres) return 1;
  if (unit == LengthUnit::kMillimetres) return 0.001;
  return std::nullopt;
}

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_STATED_UNIT_H_

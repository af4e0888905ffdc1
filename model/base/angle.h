#ifndef DUET_MODEL_BASE_ANGLE_H_
#define DUET_MODEL_BASE_ANGLE_H_

namespace duet::base {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kRadiansPerDegree = kPi / 180;
inline constexpr double kDegreesPerRadian = 180 / kPi;

}  // namespace duet::base

#endif  // DUET_MODEL_BASE_ANGLE_H_

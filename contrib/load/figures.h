#ifndef DUET_CONTRIB_LOAD_FIGURES_H_
#define DUET_CONTRIB_LOAD_FIGURES_H_

#include <cstdint>

namespace duet::contrib::load {

// Counted units per reported unit.
inline constexpr double kMillisecond = 1e6;  // nanoseconds
inline constexpr double kHertz = 1e3;        // millihertz

inline double In(double unit, int64_t value) { return static_cast<double>(value) / unit; }

}  // namespace duet::contrib::load

#endif  // DUET_CONTRIB_LOAD_FIGURES_H_

#ifndef DUET_CONTRIB_LOAD_TIME_H_
#define DUET_CONTRIB_LOAD_TIME_H_

#include <chrono>

namespace duet::contrib::load {

using Time = std::chrono::steady_clock::time_point;
using Duration = std::chrono::nanoseconds;

inline Duration Seconds(double seconds) {
  return std::chrono::duration_cast<Duration>(std::chrono::duration<double>(seconds));
}
inline double ToSeconds(Duration duration) {
  return std::chrono::duration<double>(duration).count();
}

}  // namespace duet::contrib::load

#endif  // DUET_CONTRIB_LOAD_TIME_H_

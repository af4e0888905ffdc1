#include "model/motion/beat.h"

namespace duet::motion {

std::vector<double> BeatTimes(const Beat& beat, double end_seconds) {
  std::vector<double> times = {beat.SecondsAt(0)};
  while (times.back() < end_seconds) {
    times.push_back(beat.SecondsAt(static_cast<double>(times.size())));
  }
  return times;
}

}  // namespace duet::motion

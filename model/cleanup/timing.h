#ifndef DUET_MODEL_CLEANUP_TIMING_H_
#define DUET_MODEL_CLEANUP_TIMING_H_

#include <algorithm>
#include <cmath>

namespace duet::cleanup {

// When a window's frames are, and which of them may change.
struct Timing {
  double frame_rate_hz = 0;
  // The first frames, which the window before has fixed already: no stage changes them.
  int settled = 0;

  double Frames(double seconds) const { return seconds * frame_rate_hz; }
};

// 0 to 1 with level ends, and held beyond them.
inline float SmoothStep(double t) {
  const float at = static_cast<float>(std::clamp(t, 0.0, 1.0));
  return at * at * (3 - 2 * at);
}

// The share of a correction that a frame gets: none while settled, then more over a third of a
// second, so that nothing pops where windows meet. All of it where nothing is settled.
inline float EaseIn(const Timing& timing, int frame) {
  constexpr double kSeconds = 1.0 / 3;
  if (timing.settled == 0) return 1;
  return SmoothStep((frame - timing.settled + 1) / (timing.Frames(kSeconds) + 1));
}

// A value that is left alone up to `knee` and, however large, stays below `limit`. Smooth.
inline float SoftLimit(float value, float knee, float limit) {
  if (value <= knee) return value;
  return knee + (limit - knee) * (1 - std::exp(-(value - knee) / (limit - knee)));
}

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_TIMING_H_

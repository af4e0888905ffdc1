#ifndef DUET_MODEL_CLEANUP_TIMING_H_
#define DUET_MODEL_CLEANUP_TIMING_H_

#include <algorithm>
#include <cmath>

namespace duet::cleanup {

// The frame rate of a window, and which of its frames may change.
struct Timing {
  double frame_rate_hz = 0;
  // Number of first frames that are final. No stage changes them.
  int settled = 0;
  // How long corrections take to apply in full after the settled frames. Windows that follow one
  // another within this time need a shorter one: each of them would begin anew.
  double ease_seconds = 1.0 / 3;
  // How far a foot looks ahead for a reason to step. Such windows would put off every step that
  // begins later than that.
  double anticipation_seconds = 0;
  // Whether a step in the settled frames goes on as it began. In such windows, a step that begins
  // anew would never end.
  bool continues_steps = false;

  double Frames(double seconds) const { return seconds * frame_rate_hz; }
};

// Returns 0 below 0, 1 above 1, and a smooth transition with zero slope at both ends between them.
inline float SmoothStep(double t) {
  const float at = static_cast<float>(std::clamp(t, 0.0, 1.0));
  return at * at * (3 - 2 * at);
}

// Returns the fraction of a correction that applies to a frame: 0 in settled frames, then rising to
// 1 within Timing::ease_seconds, so that the motion is continuous between windows. 1 if there are
// no settled frames.
inline float EaseIn(const Timing& timing, int frame) {
  if (timing.settled == 0) return 1;
  return SmoothStep((frame - timing.settled + 1) / (timing.Frames(timing.ease_seconds) + 1));
}

// Returns `value` up to `knee`; above, a smooth function that stays below `limit`.
inline float SoftLimit(float value, float knee, float limit) {
  if (value <= knee) return value;
  return knee + (limit - knee) * (1 - std::exp(-(value - knee) / (limit - knee)));
}

// Angles up to `free` are not corrected. Corrected angles do not exceed `most`. Degrees.
struct SoftRange {
  double free = 0;
  double most = 0;
};

}  // namespace duet::cleanup

#endif  // DUET_MODEL_CLEANUP_TIMING_H_

#ifndef DUET_CONTRIB_LOAD_LIVE_OPTIONS_H_
#define DUET_CONTRIB_LOAD_LIVE_OPTIONS_H_

#include <cstdint>
#include <functional>
#include <vector>

#include "client/request.h"
#include "contrib/load/time.h"

namespace duet::contrib::load {

// What all sessions begin with.
struct LiveContent {
  client::ModelChoice model;
  std::vector<client::ClassWeight> labels;  // empty: 1 for the model's first class
  int delay_frames = 0;
  int plan_frames = 0;
};

// How the leader frames of a session reach the server: what cameras and networks do to them.
struct LiveConditions {
  Duration jitter{0};  // each frame is sent up to this long after it was due, in order
  double loss = 0;     // fraction of frames that are never sent
  // Once in the measured time each session sends nothing for this long, then all that it held back.
  Duration stall{0};
};

// Live sessions that run side by side.
struct LiveOptions {
  int sessions = 1;
  double frame_rate_hz = 30;
  // Whether the frames of all sessions are due at the same instants. Otherwise they are spread
  // evenly over the interval between two frames, as those of independent people are.
  bool in_step = false;
  LiveConditions conditions;
  uint64_t seed = 0;
  Duration warm_up =
      std::chrono::seconds(1);  // frames that are due before its end are not measured
  Duration measured = std::chrono::seconds(10);
  Duration interval = std::chrono::seconds(1);  // of the timeline
  Duration longest_end =
      std::chrono::seconds(5);  // after which sessions that do not end are cancelled
  // Polled: after it returns true no further frame is sent. Optional.
  std::function<bool()> stopped;
};

}  // namespace duet::contrib::load

#endif  // DUET_CONTRIB_LOAD_LIVE_OPTIONS_H_

#ifndef DUET_SERVER_BATCHING_LANE_H_
#define DUET_SERVER_BATCHING_LANE_H_

#include <cstddef>

#include "server/batching/priority.h"

namespace duet::server::batching {

// The queues in which windows wait, the most urgent first. A batch contains windows of one lane
// only, so that long calls do not delay short ones.
enum class Lane {
  kShort,  // interactive calls of little work, and the first window of long ones
  kLong,   // the other windows of long interactive calls
  kBulk
};
inline constexpr std::size_t kLanes = 3;

// A call of more windows is long: more than about 20 s at 15 frames a second.
inline constexpr int kShortCallWindows = 8;

// `call_windows`: number of windows of the whole call, each counted once for each candidate: a call
// with many candidates delays others as much as one that is as many times longer. The caller waits
// for the first frames of a long call as for those of a short one. Later frames only have to keep
// up with playback.
constexpr Lane LaneOf(Priority priority, int call_windows, bool continues_call) {
  if (priority == Priority::kBulk) return Lane::kBulk;
  return continues_call && call_windows > kShortCallWindows ? Lane::kLong : Lane::kShort;
}

}  // namespace duet::server::batching

#endif  // DUET_SERVER_BATCHING_LANE_H_

#ifndef DUET_SERVER_BATCHING_LANE_H_
#define DUET_SERVER_BATCHING_LANE_H_

#include <cstddef>

#include "server/batching/priority.h"

namespace duet::server::batching {

// The lines in which windows wait, the most urgent first. A batch never mixes them: a short call
// must not be held up by the work of a long one.
enum class Lane {
  kShort,  // interactive calls that have had little so far
  kLong,   // interactive calls that have had much
  kBulk
};
inline constexpr std::size_t kLanes = 3;

// An interactive call gives way to shorter ones once so many of its frames were evaluated: 20 s at
// 15 frames a second.
inline constexpr int kLongCallFrames = 300;

// `evaluated_frames`: of the call's windows so far.
constexpr Lane LaneOf(Priority priority, int evaluated_frames) {
  if (priority == Priority::kBulk) return Lane::kBulk;
  return evaluated_frames < kLongCallFrames ? Lane::kShort : Lane::kLong;
}

}  // namespace duet::server::batching

#endif  // DUET_SERVER_BATCHING_LANE_H_

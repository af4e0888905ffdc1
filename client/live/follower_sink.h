#ifndef DUET_CLIENT_LIVE_FOLLOWER_SINK_H_
#define DUET_CLIENT_LIVE_FOLLOWER_SINK_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/live/leader_source.h"
#include "client/live_session.h"

namespace duet::client::live {

// What `duet live --to` writes to: a file, standard output, or a protocol of 3D programs.
//
// Threads: one call at a time, though not always from the same thread.
class FollowerSink {
 public:
  virtual ~FollowerSink() = default;

  // Called once, before Accept. The follower has the leader's joints and frame rate.
  virtual absl::Status Start(const LeaderFormat& format) = 0;

  // The next final frames, without gaps from frame 0 on, and the plan of the frames after them.
  // Must return quickly: the session waits. An error ends the session.
  virtual absl::Status Accept(const LiveFrames& frames) = 0;

  // A leader frame that was sent. Default: nothing.
  virtual void AcceptLeader(const LeaderFrame& /*frame*/) {}

  // Called once, after the last frame; also if the session failed after Start. Returns what was
  // written, one line each for the summary: file names, or counts of packets. `info` is what the
  // server chose, empty if the session never began.
  virtual absl::StatusOr<std::vector<std::string>> Finish(const LiveInfo& info) = 0;
};

}  // namespace duet::client::live

#endif  // DUET_CLIENT_LIVE_FOLLOWER_SINK_H_

#ifndef DUET_CLIENT_LIVE_JSON_LINES_SINK_H_
#define DUET_CLIENT_LIVE_JSON_LINES_SINK_H_

#include <ostream>
#include <string>
#include <vector>

#include "client/live/follower_sink.h"

namespace duet::client::live {

// Writes the follower as lines of JSON, each complete when it is written:
//
//   {"joints": ["head", ...], "rate": 30, "unit": "m", "up": "y"}
//   {"frame": 0, "positions": [[x, y, z], ...]}
//
// Positions have five decimals (0.01 mm). Errors: ABORTED if the reader is gone.
class JsonLinesSink final : public FollowerSink {
 public:
  // `out` outlives the sink.
  explicit JsonLinesSink(std::ostream& out) : out_(out) {}

  absl::Status Start(const LeaderFormat& format) override;
  absl::Status Accept(const LiveFrames& frames) override;
  absl::StatusOr<std::vector<std::string>> Finish(const LiveInfo& info) override;

 private:
  absl::Status Flush();

  std::ostream& out_;
  int frames_ = 0;
};

}  // namespace duet::client::live

#endif  // DUET_CLIENT_LIVE_JSON_LINES_SINK_H_

#ifndef DUET_CONTRIB_LOAD_SERVER_SESSIONS_H_
#define DUET_CONTRIB_LOAD_SERVER_SESSIONS_H_

#include <memory>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "client/options.h"
#include "client/request.h"
#include "client/result.h"
#include "contrib/load/live.h"
#include "model/motion/poses.h"

namespace duet::contrib::load {

// What all sessions begin with.
struct LiveContent {
  client::ModelChoice model;
  std::vector<client::ClassWeight> labels;  // empty: 1 for the model's first class
  int delay_frames = 0;
  int plan_frames = 0;
};

// The sessions of a target.
struct LiveSessions {
  LiveContent content;
  client::ModelInfo model;  // that of the content
  double frame_rate_hz = 30;
  std::vector<motion::Poses> leaders;  // in the model's joints, at this rate; at least one
  absl::Duration longest = absl::InfiniteDuration();  // after which a session is ended
};

// A server, over `connections` connections that sessions use in turn. Session i has the seed i and
// sends the frames of leaders[i mod n], forwards and backwards without end. Each session is one
// stream: one that breaks is not resumed.
//
// Returns after every connection is established. Errors: as ConnectCalls, and INVALID_ARGUMENT for
// content that the proto cannot represent.
absl::StatusOr<std::unique_ptr<LiveTarget>> ConnectSessions(const client::ClientOptions& options,
                                                            int connections, LiveSessions sessions);

}  // namespace duet::contrib::load

#endif  // DUET_CONTRIB_LOAD_SERVER_SESSIONS_H_

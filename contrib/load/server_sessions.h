#ifndef DUET_CONTRIB_LOAD_SERVER_SESSIONS_H_
#define DUET_CONTRIB_LOAD_SERVER_SESSIONS_H_

#include <memory>

#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "client/options.h"
#include "client/result.h"
#include "contrib/load/live.h"
#include "contrib/load/server_calls.h"

namespace duet::contrib::load {

// The sessions of a target.
struct LiveSessions {
  CallContent content;      // its frames do not count
  client::ModelInfo model;  // that of the content
  double frame_rate_hz = 30;
  absl::Duration longest = absl::InfiniteDuration();  // after which a session is ended
};

// A server, over `connections` connections that sessions use in turn. Session i has the seed i and
// sends a leader that sways (SwayingJoint). Each session is one stream: one that breaks is not
// resumed.
//
// Returns after every connection is established. Errors: as ConnectCalls, and INVALID_ARGUMENT for
// content that the proto cannot represent.
absl::StatusOr<std::unique_ptr<LiveTarget>> ConnectSessions(const client::ClientOptions& options,
                                                            int connections,
                                                            const LiveSessions& sessions);

}  // namespace duet::contrib::load

#endif  // DUET_CONTRIB_LOAD_SERVER_SESSIONS_H_

#ifndef DUET_TESTS_CLIENT_SUPPORT_REPLIES_H_
#define DUET_TESTS_CLIENT_SUPPORT_REPLIES_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/time/clock.h"
#include "absl/time/time.h"
#include "client/internal/retry.h"
#include "duet/v1/synthesis.pb.h"
#include "model/motion/clip.h"

namespace duet::test {

// A clock that moves only when somebody sleeps or a test says so, and remembers every sleep.
struct FakeTime {
  absl::Time now = absl::Now();  // so that a real server gets deadlines that it can keep
  std::vector<absl::Duration> sleeps;
  double uniform = 0;  // what the jitter draws

  client::internal::RetryEnvironment Environment();
};

// A leader of three joints: "root", "left", "right". Every position is different.
motion::Clip ThreeJointLeader(int frames);

// The messages of a good reply to `leader`: the follower is the leader moved by one metre in x.
v1::SynthesizeResponse HeaderFor(const motion::Clip& leader);
v1::SynthesizeResponse ChunkFor(const motion::Clip& leader, int first_frame, int frames);
v1::SynthesizeResponse SummaryFor(const motion::Clip& leader, int chunks);
// Header, chunks of `chunk_frames`, summary.
std::vector<v1::SynthesizeResponse> ReplyFor(const motion::Clip& leader, int chunk_frames);

// The follower that these replies carry.
motion::Poses FollowerFor(const motion::Clip& leader);

// A status as the server sends it, with an ErrorInfo; with a RetryInfo where `delay` is given.
absl::Status ServiceError(absl::StatusCode code, const std::string& message,
                          absl::Duration delay = absl::InfiniteDuration());

}  // namespace duet::test

#endif  // DUET_TESTS_CLIENT_SUPPORT_REPLIES_H_

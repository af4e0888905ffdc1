#ifndef DUET_CLIENT_INTERNAL_RETRY_H_
#define DUET_CLIENT_INTERNAL_RETRY_H_

#include <functional>
#include <string>
#include <utility>

#include "absl/functional/function_ref.h"
#include "absl/status/status.h"
#include "absl/strings/string_view.h"
#include "absl/time/time.h"
#include "client/options.h"
#include "client/request.h"

namespace duet::client::internal {

// Clock, sleep and random numbers; replaced in tests.
struct RetryEnvironment {
  std::function<absl::Time()> now;
  std::function<void(absl::Duration)> sleep;
  std::function<double()> uniform;  // in [0, 1)
};

// The system clock, a real sleep, and a random seed.
RetryEnvironment SystemEnvironment();

// Returns true if another attempt may succeed after one that failed with `status`:
//   UNAVAILABLE         always
//   CANCELLED           without details: a server that shuts down ends calls this way if it has not
//                       started to process them. A call that is cancelled on this side is never
//                       retried.
//   RESOURCE_EXHAUSTED  for bulk calls, and only with RetryInfo. Without RetryInfo it means that
//   the
//                       message is too large, which no retry can change.
bool IsRetryable(const absl::Status& status, Priority priority);

// Returns the wait after the `attempt`-th attempt (from 1) failed with `status`. Jitter is added to
// the delay in the server's RetryInfo, so that clients rejected together do not retry together.
absl::Duration RetryWait(const RetryOptions& options, int attempt, const absl::Status& status,
                         double uniform);

// Limits on the attempts of one call, besides their number.
struct RetryLimits {
  absl::Time deadline;
  absl::Duration wait;  // see ClientOptions::wait
  std::string server_address;
};

// How an attempt ended.
struct AttemptEnd {
  // NOLINTNEXTLINE(google-explicit-constructor): most attempts have only a status.
  AttemptEnd(absl::Status ended, bool server_answered = false)
      : status(std::move(ended)), answered(server_answered) {}

  absl::Status status;
  bool answered;  // the server sent part of a reply before the attempt ended
};

// Returns true if no server was reached: UNAVAILABLE from gRPC itself, which has no details, unlike
// UNAVAILABLE from a Duet server. A server whose health service reports NOT_SERVING is reachable.
bool IsUnreachable(const AttemptEnd& end);

// Returns the status of an attempt. If gRPC had no server for it, the message is a sentence that
// says why, such as "the server at localhost:50051 is not running: it refused the connection".
// gRPC's own message, which names sockets and system calls, is part of the sentence only if the
// cause is unknown. The Python client has the same sentences.
absl::Status Explained(const AttemptEnd& end, absl::string_view server_address);

// Calls `attempt` until it succeeds, fails with a status that is not retryable, or a limit is
// reached. Returns the last attempt's status. Its message contains the number of attempts, if there
// were several, and is otherwise that of Explained.
absl::Status Retry(const RetryOptions& options, const RetryEnvironment& environment,
                   Priority priority, const RetryLimits& limits,
                   absl::FunctionRef<AttemptEnd()> attempt);

}  // namespace duet::client::internal

#endif  // DUET_CLIENT_INTERNAL_RETRY_H_

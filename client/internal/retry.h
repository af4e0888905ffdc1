#ifndef DUET_CLIENT_INTERNAL_RETRY_H_
#define DUET_CLIENT_INTERNAL_RETRY_H_

#include <functional>
#include <string>
#include <utility>

#include "absl/functional/function_ref.h"
#include "absl/status/status.h"
#include "absl/time/time.h"
#include "client/options.h"
#include "client/request.h"

namespace duet::client::internal {

// Time and chance, replaced in tests.
struct RetryEnvironment {
  std::function<absl::Time()> now;
  std::function<void(absl::Duration)> sleep;
  std::function<double()> uniform;  // in [0, 1)
};

// The clock on the wall, real sleep, a random seed.
RetryEnvironment SystemEnvironment();

// Whether another attempt may succeed where this one failed.
//
// UNAVAILABLE always. CANCELLED without details as well: a server that shuts down ends so what it
// has not begun to look at, and whoever cancels a call here is not asked. RESOURCE_EXHAUSTED only
// for bulk work, which can wait, and only where the server says when to come back (RetryInfo):
// without that the code means a message that is too large, which no later attempt makes smaller.
bool IsRetryable(const absl::Status& status, Priority priority);

// The wait after the `attempt`-th attempt (from 1) failed with `status`. Jitter comes on top of the
// server's RetryInfo, so that clients sent away together do not return together.
absl::Duration RetryWait(const RetryOptions& options, int attempt, const absl::Status& status,
                         double uniform);

// What bounds the attempts at one call, besides their number.
struct RetryLimits {
  absl::Time deadline;
  absl::Duration wait;  // as ClientOptions::wait
  std::string server_address;
};

// How an attempt ended.
struct AttemptEnd {
  // NOLINTNEXTLINE(google-explicit-constructor): most attempts have nothing else to report.
  AttemptEnd(absl::Status ended, bool server_answered = false)
      : status(std::move(ended)), answered(server_answered) {}

  absl::Status status;
  bool answered;  // the server sent part of a reply before the attempt ended
};

// Whether no server was reached: UNAVAILABLE that comes from gRPC itself. Duet servers send details
// with theirs; a server whose health service says NOT_SERVING is reachable.
bool IsUnreachable(const AttemptEnd& end);

// Calls `attempt` until it succeeds, fails with a status that is not retryable, or no attempt or no
// time is left. Returns the last attempt's status. The message says how many attempts there were,
// if several, and names the server if it could not be reached for `limits.wait`.
absl::Status Retry(const RetryOptions& options, const RetryEnvironment& environment,
                   Priority priority, const RetryLimits& limits,
                   absl::FunctionRef<AttemptEnd()> attempt);

}  // namespace duet::client::internal

#endif  // DUET_CLIENT_INTERNAL_RETRY_H_

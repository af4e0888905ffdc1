#include "client/internal/retry.h"

#include <algorithm>
#include <iterator>
#include <optional>

#include "absl/random/random.h"
#include "absl/strings/cord.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "client/error_details.h"
#include "client/internal/grpc_status.h"
#include "model/base/counted.h"

namespace duet::client::internal {
namespace {

absl::Status AfterAttempts(const absl::Status& status, int attempts, std::string_view reason) {
  if (attempts == 1 && reason.empty()) return status;
  return AppendMessage(status, absl::StrCat(" (after ", base::Counted(attempts, "attempt"),
                                            std::string(reason), ")"));
}

absl::Status NoServer(const absl::Status& status, int attempts, absl::Duration spent) {
  return AppendMessage(status, absl::StrCat(" (", base::Counted(attempts, "attempt"), " in ",
                                            absl::ToInt64Milliseconds(spent) / 1000.0, " s)"));
}

bool HasDetails(const absl::Status& status) {
  bool any = false;
  status.ForEachPayload([&any](absl::string_view, const absl::Cord&) { any = true; });
  return any;
}

// Whether the status is gRPC's own and not that of a server.
bool HasNoServer(const AttemptEnd& end) {
  return end.status.code() == absl::StatusCode::kUnavailable && !end.answered &&
         !HasDetails(end.status);
}

struct Cause {
  absl::string_view sign;  // part of gRPC's message
  absl::string_view text;  // what follows the address
};

// The first one whose sign is in the message applies: gRPC's message of a failed handshake contains
// its cause.
constexpr Cause kCauses[] = {
    {"unhealthy", "is not ready: it loads its models, or it shuts down"},
    {"Connection refused", "is not running: it refused the connection"},
    {"No such file or directory", "is not running: its socket does not exist"},
    {"DNS resolution failed", "cannot be found: the name has no address"},
    {"http1.x", "is not a Duet server: it does not speak gRPC"},
    {"HTTP/2", "is not a Duet server: it does not speak gRPC"},
    {"wrong version number", "does not encrypt, but this client does"},
    {"certificate verify failed", "is not trusted: its certificate was not accepted"},
    {"CERTIFICATE_VERIFY_FAILED", "is not trusted: its certificate was not accepted"},
    {"Ssl handshake failed", "cannot be reached: the TLS handshake failed"},
    {"timed out", "does not answer: the connection timed out"},
    {"No route to host", "cannot be reached: there is no route to it"},
    {"Network is unreachable", "cannot be reached: there is no route to it"},
    // A server that encrypts does so to a client that does not.
    {"Connection reset", "closed the connection: it has stopped, or it expects TLS"},
    {"Socket closed", "closed the connection: it has stopped, or it expects TLS"},
};

}  // namespace

RetryEnvironment SystemEnvironment() {
  return {[] { return absl::Now(); }, [](absl::Duration wait) { absl::SleepFor(wait); },
          [] {
            thread_local absl::BitGen generator;
            return absl::Uniform<double>(generator, 0.0, 1.0);
          }};
}

bool IsRetryable(const absl::Status& status, Priority priority) {
  if (status.code() == absl::StatusCode::kUnavailable) return true;
  if (status.code() == absl::StatusCode::kCancelled) return !HasDetails(status);
  return status.code() == absl::StatusCode::kResourceExhausted && priority == Priority::kBulk &&
         RetryDelay(status).has_value();
}

absl::Duration RetryWait(const RetryOptions& options, int attempt, const absl::Status& status,
                         double uniform) {
  absl::Duration ceiling = options.initial_backoff;
  for (int i = 1; i < attempt && ceiling < options.max_backoff; ++i) ceiling *= 2;
  ceiling = std::min(ceiling, options.max_backoff);
  const absl::Duration backoff = ceiling * (0.5 + 0.5 * uniform);
  const std::optional<absl::Duration> pushback = RetryDelay(status);
  if (!pushback.has_value() || *pushback < backoff) return backoff;
  return *pushback + ceiling * 0.5 * uniform;
}

bool IsUnreachable(const AttemptEnd& end) {
  // "backend unhealthy" is how gRPC reports NOT_SERVING.
  return HasNoServer(end) && !absl::StrContains(end.status.message(), "unhealthy");
}

absl::Status Explained(const AttemptEnd& end, absl::string_view server_address) {
  if (!HasNoServer(end)) return end.status;
  const absl::string_view message = end.status.message();
  const auto cause = std::find_if(
      std::begin(kCauses), std::end(kCauses),
      [message](const Cause& known) { return absl::StrContains(message, known.sign); });
  return absl::Status(
      end.status.code(),
      absl::StrCat("the server at ", server_address, " ",
                   cause == std::end(kCauses) ? absl::StrCat("cannot be reached: ", message)
                                              : std::string(cause->text)));
}

absl::Status Retry(const RetryOptions& options, const RetryEnvironment& environment,
                   Priority priority, const RetryLimits& limits,
                   absl::FunctionRef<AttemptEnd()> attempt) {
  const absl::Time begin = environment.now();
  // When the first of the most recent consecutive attempts that reached no server ended.
  absl::Time away_since = absl::InfiniteFuture();
  for (int made = 1;; ++made) {
    const AttemptEnd end = attempt();
    if (end.status.ok()) return end.status;
    const bool unreachable = IsUnreachable(end);
    const absl::Status status = Explained(end, limits.server_address);
    if (!IsRetryable(status, priority) || made >= options.max_attempts) {
      return AfterAttempts(status, made, "");
    }
    const absl::Time now = environment.now();
    away_since = unreachable ? std::min(away_since, now) : absl::InfiniteFuture();
    const absl::Duration left = away_since + limits.wait - now;
    // Make the last attempt at the end of the wait, not up to a whole backoff earlier.
    const absl::Duration wait =
        std::min(left, RetryWait(options, made, status, environment.uniform()));
    const bool too_late = now + wait >= limits.deadline;
    if (unreachable && (too_late || left <= absl::ZeroDuration())) {
      return NoServer(status, made, now - begin);
    }
    if (too_late) return AfterAttempts(status, made, ", the deadline leaves no time for another");
    if (options.on_wait) options.on_wait(status, wait);
    environment.sleep(wait);
  }
}

}  // namespace duet::client::internal

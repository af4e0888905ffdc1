#include "client/internal/retry.h"

#include <algorithm>
#include <memory>
#include <optional>

#include "absl/random/random.h"
#include "absl/strings/cord.h"
#include "absl/strings/str_cat.h"
#include "absl/synchronization/mutex.h"
#include "absl/time/clock.h"
#include "client/error_details.h"
#include "client/internal/grpc_status.h"

namespace duet::client::internal {
namespace {

absl::Status AfterAttempts(const absl::Status& status, int attempts, std::string_view reason) {
  if (attempts == 1 && reason.empty()) return status;
  return AppendMessage(status,
                       absl::StrCat(" (after ", attempts, attempts == 1 ? " attempt" : " attempts",
                                    std::string(reason), ")"));
}

bool HasDetails(const absl::Status& status) {
  bool any = false;
  status.ForEachPayload([&any](absl::string_view, const absl::Cord&) { any = true; });
  return any;
}

// Random numbers in [0, 1) for calls from any thread; copies share one generator.
class SharedUniform {
 public:
  double operator()() {
    absl::MutexLock lock(&state_->mutex);
    return absl::Uniform<double>(state_->generator, 0.0, 1.0);
  }

 private:
  struct State {
    absl::Mutex mutex;
    absl::BitGen generator;
  };
  std::shared_ptr<State> state_ = std::make_shared<State>();
};

}  // namespace

RetryEnvironment SystemEnvironment() {
  return {[] { return absl::Now(); }, [](absl::Duration wait) { absl::SleepFor(wait); },
          SharedUniform()};
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

absl::Status Retry(const RetryOptions& options, const RetryEnvironment& environment,
                   Priority priority, absl::Time deadline,
                   absl::FunctionRef<absl::Status()> attempt) {
  for (int made = 1;; ++made) {
    absl::Status status = attempt();
    if (status.ok()) return status;
    if (!IsRetryable(status, priority) || made >= options.max_attempts) {
      return AfterAttempts(status, made, "");
    }
    const absl::Duration wait = RetryWait(options, made, status, environment.uniform());
    if (environment.now() + wait >= deadline) {
      return AfterAttempts(status, made, ", the deadline leaves no time for another");
    }
    if (options.on_wait) options.on_wait(status, wait);
    environment.sleep(wait);
  }
}

}  // namespace duet::client::internal

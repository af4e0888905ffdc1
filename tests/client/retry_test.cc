#include "client/internal/retry.h"

#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/client/support/replies.h"
#include "tests/support/matchers.h"

namespace duet::client::internal {
namespace {

using test::FakeTime;
using test::ServiceError;

constexpr absl::Duration kMillisecond = absl::Milliseconds(1);

absl::Status Unavailable() { return ServiceError(absl::StatusCode::kUnavailable, "away"); }

// What gRPC says of a server that it cannot reach.
absl::Status Refused() { return absl::UnavailableError("Connection refused"); }

// Runs Retry over scripted outcomes and counts the attempts.
class RetryTest : public ::testing::Test {
 protected:
  absl::Status Run(std::vector<absl::Status> outcomes, Priority priority = Priority::kInteractive) {
    const RetryLimits limits = {time_.now + deadline_, wait_, "lab:50051"};
    return Retry(options_, time_.Environment(), priority, limits, [&]() -> AttemptEnd {
      const auto attempt = static_cast<size_t>(attempts_++);
      if (attempt < outcomes.size()) return outcomes[attempt];
      ADD_FAILURE() << "attempt " << attempts_ << " was not expected";
      return absl::InternalError("not scripted");
    });
  }

  RetryOptions options_;
  FakeTime time_;
  absl::Duration deadline_ = absl::Minutes(1);
  absl::Duration wait_ = absl::Seconds(5);
  int attempts_ = 0;
};

TEST_F(RetryTest, UnavailableIsRetriedWithGrowingWaitsUpToMaxAttempts) {
  options_.max_attempts = 4;
  time_.uniform = 1;
  absl::Status status = Run(std::vector<absl::Status>(4, Unavailable()));
  EXPECT_THAT(status, StatusIs(absl::StatusCode::kUnavailable, HasSubstr("after 4 attempts")));
  EXPECT_EQ(attempts_, 4);
  EXPECT_THAT(time_.sleeps,
              ElementsAre(100 * kMillisecond, 200 * kMillisecond, 400 * kMillisecond));
  attempts_ = 0;
  EXPECT_THAT(Run({absl::CancelledError("CANCELLED"), absl::OkStatus()}), IsOk())
      << "dropped without a status";
}

TEST_F(RetryTest, OnlyTheDeadlineEndsTheAttempts) {
  const absl::Time begin = time_.now;
  EXPECT_THAT(Run(std::vector<absl::Status>(100, Unavailable())),
              StatusIs(absl::StatusCode::kUnavailable,
                       HasSubstr("the deadline leaves no time for another")));
  EXPECT_GT(time_.now - begin, deadline_ - options_.max_backoff);
}

TEST_F(RetryTest, UnreachableServerIsRetriedForTheWaitAndThenReported) {
  const absl::Time begin = time_.now;
  const absl::Status status = Run(std::vector<absl::Status>(100, Refused()));
  EXPECT_THAT(status, StatusIs(absl::StatusCode::kUnavailable,
                               "the server at lab:50051 is not running: it refused the connection "
                               "(8 attempts in 5 s)"));
  EXPECT_EQ(time_.now - begin, wait_);
}

TEST_F(RetryTest, UnreachableServerIsDescribedInWordsAlsoAfterTheLastAttempt) {
  options_.max_attempts = 2;
  std::vector<std::string> told;
  options_.on_wait = [&](const absl::Status& why, absl::Duration) {
    told.emplace_back(why.message());
  };
  const std::string words = "the server at lab:50051 is not running: it refused the connection";
  EXPECT_THAT(Run({Refused(), Refused()}),
              StatusIs(absl::StatusCode::kUnavailable, words + " (after 2 attempts)"));
  EXPECT_THAT(told, ElementsAre(words));
}

TEST(ExplainedTest, NamesTheCauseWithoutSocketsAndSystemCalls) {
  const std::string all = "failed to connect to all addresses; last error: UNKNOWN: ";
  // As reported by the policy that distributes calls over several servers.
  const std::string several = "connections to all backends failing; last error: UNAVAILABLE: ";
  const std::string tls = all + "ipv4:10.0.0.1:1: Ssl handshake failed: SSL_ERROR_SSL: ";
  const std::pair<std::string, const char*> causes[] = {
      {all + "ipv4:10.0.0.1:1: Failed to connect to remote host: Connection refused",
       "is not running: it refused the connection"},
      {all + "unix:/run/duet.sock: No such file or directory",
       "is not running: its socket does not exist"},
      {"DNS resolution failed for a:1: C-ares status is not ARES_SUCCESS: Domain name not found",
       "cannot be found: the name has no address"},
      {all + "Trying to connect an http1.x server", "is not a Duet server: it does not speak gRPC"},
      {tls + "error:0A00010B:SSL routines::wrong version number",
       "does not encrypt, but this client does"},
      {tls + "error:0A000086:SSL routines::certificate verify failed",
       "is not trusted: its certificate was not accepted"},
      {all + "connection attempt timed out before receiving SETTINGS frame",
       "does not answer: the connection timed out"},
      {several + "Failed parsing HTTP/2", "is not a Duet server: it does not speak gRPC"},
      {several + "Socket closed", "closed the connection: it has stopped, or it expects TLS"},
      {several + "backend unhealthy", "is not ready: it loads its models, or it shuts down"},
      {"odd", "cannot be reached: odd"}};
  for (const auto& [message, cause] : causes) {
    EXPECT_THAT(
        Explained(absl::UnavailableError(message), "a:1"),
        StatusIs(absl::StatusCode::kUnavailable, absl::StrCat("the server at a:1 ", cause)));
  }
}

TEST_F(RetryTest, AnyReplyRestartsTheWait) {
  wait_ = absl::Milliseconds(100);
  const RetryLimits limits = {time_.now + deadline_, wait_, "lab:50051"};
  const std::vector<AttemptEnd> ends = {Refused(),     {Refused(), true}, Refused(),
                                        Unavailable(), Refused(),         absl::OkStatus()};
  EXPECT_THAT(Retry(options_, time_.Environment(), Priority::kInteractive, limits,
                    [&] { return ends[static_cast<size_t>(attempts_++)]; }),
              IsOk());
  EXPECT_EQ(attempts_, 6);
}

TEST(IsUnreachableTest, StatusWithDetailsOrUnhealthyServerIsReachable) {
  EXPECT_TRUE(IsUnreachable(Refused()));
  EXPECT_FALSE(IsUnreachable({Refused(), /*server_answered=*/true}));
  EXPECT_FALSE(IsUnreachable(Unavailable()));
  EXPECT_FALSE(IsUnreachable(absl::UnavailableError("last error: backend unhealthy")));
  EXPECT_FALSE(IsUnreachable(absl::InternalError("")));
}

TEST_F(RetryTest, OtherCodesAreFinal) {
  for (absl::StatusCode code :
       {absl::StatusCode::kInvalidArgument, absl::StatusCode::kNotFound,
        absl::StatusCode::kInternal, absl::StatusCode::kDeadlineExceeded,
        absl::StatusCode::kCancelled, absl::StatusCode::kFailedPrecondition}) {
    attempts_ = 0;
    EXPECT_THAT(Run({ServiceError(code, "no", kMillisecond)}), StatusIs(code, "no"));
    EXPECT_EQ(attempts_, 1);
  }
}

TEST_F(RetryTest, AFullServerIsRetriedForBulkWorkIfItSaysWhen) {
  const auto full = [](absl::Duration delay) {
    return ServiceError(absl::StatusCode::kResourceExhausted, "full", delay);
  };
  EXPECT_THAT(Run({full(absl::Seconds(7)), absl::OkStatus()}, Priority::kBulk), IsOk());
  EXPECT_THAT(time_.sleeps, ElementsAre(absl::Seconds(7)));
  const auto is_final = StatusIs(absl::StatusCode::kResourceExhausted, "full");
  attempts_ = 0;
  EXPECT_THAT(Run({full(kMillisecond)}), is_final) << "interactive";
  attempts_ = 0;
  EXPECT_THAT(Run({full(absl::InfiniteDuration())}, Priority::kBulk), is_final) << "too large";
}

TEST(RetryWaitTest, JitterIsAddedToTheLongerOfBackoffAndRetryDelay) {
  const RetryOptions options;
  const auto wait = [&](int attempt, absl::Duration delay, double jitter) {
    const auto status = ServiceError(absl::StatusCode::kUnavailable, "later", delay);
    return RetryWait(options, attempt, status, jitter);
  };
  EXPECT_EQ(wait(1, absl::ZeroDuration(), 0), 50 * kMillisecond);
  EXPECT_EQ(wait(1, absl::ZeroDuration(), 1), 100 * kMillisecond);
  EXPECT_EQ(wait(1, absl::Seconds(3), 0), absl::Seconds(3));
  EXPECT_EQ(wait(1, absl::Seconds(3), 1), absl::Seconds(3) + 50 * kMillisecond);
  EXPECT_EQ(wait(1'000'000, absl::ZeroDuration(), 1), options.max_backoff);
}

TEST_F(RetryTest, StopsWhenTheWaitWouldPassTheDeadline) {
  deadline_ = absl::Seconds(5);
  const absl::Status later =
      ServiceError(absl::StatusCode::kUnavailable, "later", absl::Seconds(7));
  EXPECT_THAT(Run({later}), StatusIs(absl::StatusCode::kUnavailable,
                                     HasSubstr("the deadline leaves no time for another")));
  EXPECT_THAT(time_.sleeps, IsEmpty());
}

}  // namespace
}  // namespace duet::client::internal

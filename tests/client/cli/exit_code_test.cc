#include "client/cli/exit_code.h"

#include "gtest/gtest.h"
#include "tests/client/support/fake_stub.h"

namespace duet::client::cli {
namespace {

ExitCode CodeFor(absl::StatusCode code) { return ExitCodeFor(absl::Status(code, "")); }

TEST(ExitCodeTest, OkExitsWithZero) { EXPECT_EQ(ExitCodeFor(absl::OkStatus()), 0); }

TEST(ExitCodeTest, TemporaryErrorsExitWithRetry) {
  for (absl::StatusCode code :
       {absl::StatusCode::kUnavailable, absl::StatusCode::kDeadlineExceeded,
        absl::StatusCode::kCancelled, absl::StatusCode::kAborted, absl::StatusCode::kInternal,
        absl::StatusCode::kUnknown, absl::StatusCode::kDataLoss}) {
    EXPECT_EQ(CodeFor(code), 1) << code;
  }
}

TEST(ExitCodeTest, PermanentErrorsExitWithBadInput) {
  for (absl::StatusCode code :
       {absl::StatusCode::kInvalidArgument, absl::StatusCode::kFailedPrecondition,
        absl::StatusCode::kOutOfRange, absl::StatusCode::kNotFound,
        absl::StatusCode::kAlreadyExists, absl::StatusCode::kPermissionDenied,
        absl::StatusCode::kUnauthenticated, absl::StatusCode::kUnimplemented}) {
    EXPECT_EQ(CodeFor(code), 42) << code;
  }
}

TEST(ExitCodeTest, FullServerExitsWithRetryAndTooLargeMessageDoesNot) {
  EXPECT_EQ(ExitCodeFor(
                test::ServiceError(absl::StatusCode::kResourceExhausted, "full", absl::Seconds(1))),
            1);
  EXPECT_EQ(CodeFor(absl::StatusCode::kResourceExhausted), 42);
}

}  // namespace
}  // namespace duet::client::cli

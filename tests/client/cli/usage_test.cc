// Command lines that run nothing: help, versions, usage errors, settings and exit codes.
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/cli/command.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/client/cli/program_runner.h"
#include "tests/client/support/replies.h"
#include "tests/support/matchers.h"

namespace duet::client::cli {
namespace {

using test::WriteTestFile;

class UsageTest : public ProgramRunner {
 protected:
  void ExpectUsageError(const Strings& arguments, const std::string& message) {
    EXPECT_EQ(Run(arguments), kExitUsage) << message;
    EXPECT_THAT(err(), HasSubstr(message));
    EXPECT_EQ(out(), "");
  }

  // The required flags of `duet synthesize` except its labels.
  const Strings unlabelled_ = {"synthesize", "--leader", "kick.bvh", "--out", Path("pair.html")};
  const Strings synthesize_ = unlabelled_ + Strings{"--label", "kick"};
};

TEST_F(UsageTest, VersionAndHelpSucceed) {
  EXPECT_EQ(Run({"--version"}), 0);
  EXPECT_EQ(out(), "duet " DUET_VERSION "\n");
  for (const Strings& arguments : {Strings{"--help"}, Strings{"synthesize", "--help"},
                                   Strings{"models", "--help"}, Strings{"admin", "--help"}}) {
    EXPECT_EQ(Run(arguments), 0);
    EXPECT_THAT(out(), HasSubstr("Usage: duet"));
  }
  EXPECT_EQ(Run({"--help-all"}), 0);
  for (const char* text : {"--candidates COUNT", "--rig FILE", "--admin-server HOST:PORT"}) {
    EXPECT_THAT(out(), HasSubstr(text));
  }
}

TEST_F(UsageTest, HelpShowsDefaultsAndExitCodes) {
  EXPECT_EQ(Run({"synthesize", "--help"}), 0);
  const std::pair<const char*, const char*> defaults[] = {{"--server HOST:PORT", "localhost:50051"},
                                                          {"--timeout SECONDS", "120"},
                                                          {"--wait SECONDS", "5"},
                                                          {"--leader-side left.right", "left"}};
  for (const auto& [flag, value] : defaults) {
    // CLI11 2.1 and 2.4 write them differently: "=5" and " [5]".
    EXPECT_THAT(out(), ContainsRegex(absl::StrCat(flag, "[^\n]*[=[]", value)));
  }
  EXPECT_THAT(out(), HasSubstr("  42  failed"));
}

TEST_F(UsageTest, ErrorsNameTheFlagWhatIsExpectedAndWhatIsGiven) {
  const struct {
    Strings more;
    const char* message;
  } cases[] = {
      {{"--candidates", "17"}, "--candidates: expected 1 to 16, got \"17\""},
      {{"--wait", "x"}, "--wait: expected 0 to 86400, got \"x\""},
      {{"--timeout", "nan"}, "--timeout: expected 0.001 to 86400, got \"nan\""},
      {{"--timeout"}, "--timeout: 1 required"},
      {{"--server", "a", "--server", "b"}, "--server"},
      {{"--json=maybe"}, "--json = maybe"},
      {{"--label", "kick="}, "--label: expected CLASS or CLASS=WEIGHT"},
      {{"hug=1"}, "hug=1"},
      {{"--keyframe", "0:kick=1"}, "excludes"},
      {{"--leader-side", "up"}, "--leader-side: expected left or right, got \"up\""},
      {{"--input-format", "mov"}, "--input-format: expected "},
      {{"--frame-rate", "-15"}, "--frame-rate: expected a number above 0, got \"-15\""},
      {{"--metres-per-unit", "inf"}, "--metres-per-unit: expected a number above 0, got \"inf\""},
      {{"--tls-key", "key.pem"}, "--tls-key"},
      {{"--tls-cert", "a.pem"}, "--tls-key"},
      {{"--model", "sbu@x"}, "--model: expected NAME"},
      {{"--seed", "-1"}, "--seed: expected a whole number"},
      {{"--variety", "3"}, "--variety: expected a number from 0 to 2, got \"3\""},
      {{"--out", Path("pair.fbx")}, "got \".fbx\""},
      {{"--out", Path("no/pair.csv")}, "there is no folder"}};
  for (const auto& [more, message] : cases) ExpectUsageError(synthesize_ + more, message);
  ExpectUsageError(unlabelled_ + Strings{"--keyframe", "kick=1"},
                   "--keyframe: expected FRAME:CLASS=WEIGHT");
}

TEST_F(UsageTest, WhatIsMissingOrUnknownIsNamed) {
  ExpectUsageError({}, "subcommand is required");
  ExpectUsageError({"dance"}, "Expected a command, got \"dance\"");
  ExpectUsageError({"models", "extra"}, "extra");
  ExpectUsageError({"models", "--frobnicate"}, "--frobnicate");
  ExpectUsageError({"admin", "models", "--server", "a"}, "--server");
  ExpectUsageError(unlabelled_, "--label, --keyframe or --request is required");
  ExpectUsageError({"synthesize", "--label", "kick", "--out", Path("pair.html")}, "--leader");
  ExpectUsageError({"synthesize", "--leader", "kick.bvh", "--label", "kick"}, "--out");
  ExpectUsageError({"batch", "--out", "x", "--recipe", "r"}, "leaders or --manifest");
  ExpectUsageError({"batch", "walks", "--out", "x"}, "--recipe");
  ExpectUsageError({"batch", "walks", "--recipe", "r"}, "--out");
  ExpectUsageError({"batch", "walks", "--manifest", "m"}, "excludes");
  ExpectUsageError({"batch", "walks", "--shard", "3/3"}, "INDEX/COUNT");
}

ExitCode CodeFor(absl::StatusCode code) { return ExitCodeFor(absl::Status(code, "")); }

TEST(ExitCodeTest, FollowsTheStatus) {
  EXPECT_EQ(ExitCodeFor(absl::OkStatus()), 0);
  for (const absl::StatusCode code :
       {absl::StatusCode::kUnavailable, absl::StatusCode::kDeadlineExceeded,
        absl::StatusCode::kCancelled, absl::StatusCode::kAborted, absl::StatusCode::kInternal,
        absl::StatusCode::kUnknown, absl::StatusCode::kDataLoss}) {
    EXPECT_EQ(CodeFor(code), 1) << code;
  }
  for (const absl::StatusCode code :
       {absl::StatusCode::kInvalidArgument, absl::StatusCode::kFailedPrecondition,
        absl::StatusCode::kOutOfRange, absl::StatusCode::kNotFound,
        absl::StatusCode::kAlreadyExists, absl::StatusCode::kPermissionDenied,
        absl::StatusCode::kUnauthenticated, absl::StatusCode::kUnimplemented}) {
    EXPECT_EQ(CodeFor(code), 42) << code;
  }
  // A full server says when to retry; for a message that is too large, no retry helps.
  EXPECT_EQ(ExitCodeFor(
                test::ServiceError(absl::StatusCode::kResourceExhausted, "full", absl::Seconds(1))),
            1);
  EXPECT_EQ(CodeFor(absl::StatusCode::kResourceExhausted), 42);
}

}  // namespace
}  // namespace duet::client::cli

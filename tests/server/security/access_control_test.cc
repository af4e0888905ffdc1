#include "server/security/access_control.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "absl/strings/string_view.h"
#include "server/common/error_details.h"
#include "tests/server/support/fakes.h"
#include "tests/support/matchers.h"

namespace duet::server::security {
namespace {

constexpr absl::string_view kAllowed = "";
using std::chrono::milliseconds;
using test::FakeClock;

Caller Studio() { return {"studio", {Role::kSynthesise}, {"digest-1", "digest-2"}, {}, {}}; }
Caller Farm() { return {"farm", {Role::kSynthesise}, {}, {"farm.example"}, {}}; }
Caller Ops() { return {"ops", {Role::kAdmin}, {"digest-ops"}, {"ops.example"}, {}}; }

Credentials Token(const std::string& digest) { return {true, digest, {}}; }
Credentials Certificate(const std::string& name) { return {false, "", {name}}; }

class AccessControlTest : public ::testing::Test {
 protected:
  AccessControlTest() { access_.Replace({Studio(), Farm(), Ops()}); }
  // The reason of the refusal; kAllowed if there is none.
  std::string Ask(const Credentials& credentials, Role role = Role::kSynthesise) const {
    return common::ReasonOf(access_.Admit(credentials, role).status);
  }

  FakeClock clock_;
  AccessControl access_{clock_};
};

TEST_F(AccessControlTest, AcceptsEachTokenOfACaller) {
  for (const char* digest : {"digest-1", "digest-2"}) {
    const CallPass pass = access_.Admit(Token(digest), Role::kSynthesise);
    EXPECT_THAT(pass.status, IsOk());
    EXPECT_EQ(pass.name, "studio");
    EXPECT_TRUE(pass.is_listed);
  }
}

TEST_F(AccessControlTest, AcceptsANameInACertificate) {
  EXPECT_EQ(Ask(Certificate("farm.example")), kAllowed);
  EXPECT_EQ(Ask({false, "", {"other.example", "farm.example"}}), kAllowed);
}

TEST_F(AccessControlTest, RejectsACallWithoutCredentials) {
  EXPECT_EQ(Ask({}), common::kReasonCredentialsMissing);
  EXPECT_EQ(Ask(Token("digest-3")), common::kReasonCredentialsInvalid);
  EXPECT_EQ(Ask(Token("")), common::kReasonCredentialsInvalid);
  EXPECT_EQ(Ask(Certificate("stranger.example")), common::kReasonCallerUnknown);
}

TEST_F(AccessControlTest, TokenOverridesTheCertificate) {
  EXPECT_EQ(Ask({true, "digest-3", {"farm.example"}}), common::kReasonCredentialsInvalid);
  EXPECT_EQ(access_.Admit({true, "digest-1", {"farm.example"}}, Role::kSynthesise).name, "studio");
}

TEST_F(AccessControlTest, NeitherRoleIncludesTheOther) {
  EXPECT_EQ(Ask(Token("digest-1"), Role::kAdmin), common::kReasonRoleMissing);
  EXPECT_EQ(Ask(Token("digest-ops"), Role::kSynthesise), common::kReasonRoleMissing);
  EXPECT_EQ(Ask(Token("digest-ops"), Role::kAdmin), kAllowed);
}

TEST_F(AccessControlTest, NewListAppliesAtOnce) {
  Caller rotated = Studio();
  rotated.token_digests = {"digest-9"};
  access_.Replace({rotated});
  EXPECT_EQ(Ask(Token("digest-1")), common::kReasonCredentialsInvalid);
  EXPECT_EQ(Ask(Token("digest-9")), kAllowed);
  EXPECT_EQ(Ask(Certificate("farm.example")), common::kReasonCallerUnknown);
}

TEST_F(AccessControlTest, NewListKeepsTheUsageOfCallers) {
  Caller limited = Studio();
  limited.calls_per_second = 1;
  access_.Replace({limited});
  EXPECT_EQ(Ask(Token("digest-1"), Role::kAdmin), common::kReasonRoleMissing) << "which is no call";
  EXPECT_EQ(Ask(Token("digest-1")), kAllowed);
  access_.Replace({limited});
  EXPECT_EQ(Ask(Token("digest-1")), common::kReasonCallRate);
}

TEST_F(AccessControlTest, ListCanBeReplacedDuringCalls) {
  std::atomic<int> allowed{0};
  std::vector<std::thread> callers;
  for (int t = 0; t < 3; ++t) {
    callers.emplace_back([&] {
      for (int i = 0; i < 200; ++i) allowed += Ask(Token("digest-1")) == kAllowed ? 1 : 0;
    });
  }
  for (int i = 0; i < 100; ++i) access_.Replace({Studio(), Farm()});
  for (std::thread& caller : callers) caller.join();
  EXPECT_EQ(allowed.load(), 600);
}

TEST(CallerUsageTest, AllowsABurstOfOneSecondsCallsAndThenARate) {
  FakeClock clock;
  CallerUsage usage;
  for (int i = 0; i < 4; ++i) EXPECT_FALSE(usage.TakeCall(4, clock.Now()).has_value()) << i;
  EXPECT_DOUBLE_EQ(usage.TakeCall(4, clock.Now()).value(), 0.25) << "the time to wait";
  clock.Advance(milliseconds(100));
  EXPECT_NEAR(usage.TakeCall(4, clock.Now()).value(), 0.15, 1e-9);
  clock.Advance(milliseconds(150));
  EXPECT_FALSE(usage.TakeCall(4, clock.Now()).has_value());
  EXPECT_TRUE(usage.TakeCall(4, clock.Now()).has_value());
  clock.Advance(milliseconds(3'600'000));
  int taken = 0;
  while (taken < 100 && !usage.TakeCall(4, clock.Now()).has_value()) ++taken;
  EXPECT_EQ(taken, 4) << "a pause saves no more";
}

TEST(CallerUsageTest, OlderTimeAddsNoCalls) {
  FakeClock clock;
  const common::TimePoint early = clock.Now();
  clock.Advance(milliseconds(1000));
  CallerUsage usage;
  for (int i = 0; i < 2; ++i) EXPECT_FALSE(usage.TakeCall(2, clock.Now()).has_value());
  EXPECT_TRUE(usage.TakeCall(2, early).has_value());
  EXPECT_TRUE(usage.TakeCall(2, clock.Now()).has_value());
}

TEST(CallerUsageTest, ConcurrentCallsDoNotExceedTheLimit) {
  FakeClock clock;
  CallerUsage usage;
  std::atomic<int> calls{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&] {
      for (int i = 0; i < 200; ++i) {
        if (!usage.TakeCall(100, clock.Now()).has_value()) ++calls;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(calls.load(), 100);
}

}  // namespace
}  // namespace duet::server::security

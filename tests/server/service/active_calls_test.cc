#include "server/service/active_calls.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace duet::server::service {
namespace {

using std::chrono::seconds;

constexpr common::TimePoint kBegin{};

// A call whose reader has kept a message waiting since then, or takes everything.
class FakeCall final : public ActiveCall {
 public:
  FakeCall(std::string client, std::optional<common::TimePoint> since)
      : client_(std::move(client)), since_(since) {}

  void Drain() override { ++drains; }
  void Abort(const absl::Status& reason) override { aborted = reason; }
  void CheckTime(common::TimePoint) override {}
  const std::string& client() const override { return client_; }
  std::optional<common::TimePoint> waiting_since() const override { return since_; }
  std::optional<std::size_t> GiveUpReader(common::TimePoint now, double least) override {
    if (!since_.has_value() || common::SecondsBetween(*since_, now) < least) return std::nullopt;
    since_ = std::nullopt;
    given_up = true;
    return 7;
  }

  std::optional<common::TimePoint> idle_since() const override { return idle; }
  bool GiveUpIdle(common::TimePoint now, double least) override {
    if (!idle.has_value() || common::SecondsBetween(*idle, now) < least) return false;
    idle = std::nullopt;
    given_up = true;
    return true;
  }

  std::optional<absl::Status> aborted;
  std::optional<common::TimePoint> idle;  // since when it waits for a message
  bool given_up = false;
  int drains = 0;

 private:
  const std::string client_;
  std::optional<common::TimePoint> since_;
};

std::shared_ptr<FakeCall> AddCall(ActiveCalls& calls, std::string client,
                                  std::optional<common::TimePoint> since) {
  auto call = std::make_shared<FakeCall>(std::move(client), since);
  calls.Add(call);
  return call;
}

TEST(ActiveCallsTest, CallAfterShutdownEndsImmediately) {
  ActiveCalls calls;
  const auto before = AddCall(calls, "a", std::nullopt);
  calls.AbortAll(absl::UnavailableError("over"));
  const auto after = AddCall(calls, "a", std::nullopt);
  EXPECT_EQ(before->aborted, absl::UnavailableError("over"));
  EXPECT_EQ(after->aborted, absl::UnavailableError("over"));
}

TEST(ActiveCallsTest, EveryCallLearnsOfADrainOnce) {
  ActiveCalls calls;
  const auto before = AddCall(calls, "a", std::nullopt);
  EXPECT_EQ(before->drains, 0);
  calls.Drain();
  const auto after = AddCall(calls, "a", std::nullopt);
  EXPECT_EQ(before->drains, 1);
  EXPECT_EQ(after->drains, 1) << "it was admitted before the drain began";
}

TEST(ActiveCallsTest, EndsTheCallOfTheLongestStalledReader) {
  ActiveCalls calls;
  const auto late = AddCall(calls, "a", kBegin + seconds(2));
  const auto early = AddCall(calls, "a", kBegin + seconds(1));
  const auto reads = AddCall(calls, "a", std::nullopt);
  EXPECT_EQ(calls.GiveUpSlowestReader("a", kBegin + seconds(5), 2), 7u);
  EXPECT_TRUE(early->given_up);
  EXPECT_FALSE(late->given_up);
  EXPECT_EQ(calls.GiveUpSlowestReader("a", kBegin + seconds(5), 2), 7u);
  EXPECT_TRUE(late->given_up);
  EXPECT_EQ(calls.GiveUpSlowestReader("a", kBegin + seconds(5), 2), std::nullopt);
  EXPECT_FALSE(reads->given_up);
}

TEST(ActiveCallsTest, LeavesReadersOfOtherClientsAlone) {
  ActiveCalls calls;
  const auto other = AddCall(calls, "b", kBegin);
  EXPECT_EQ(calls.GiveUpSlowestReader("a", kBegin + seconds(9), 2), std::nullopt);
  EXPECT_FALSE(other->given_up);
  EXPECT_EQ(calls.GiveUpSlowestReader(std::nullopt, kBegin + seconds(9), 2), 7u);
  EXPECT_TRUE(other->given_up);
}

TEST(ActiveCallsTest, KeepsAReaderThatStalledForLessThanTheLimit) {
  ActiveCalls calls;
  const auto call = AddCall(calls, "a", kBegin);
  EXPECT_EQ(calls.GiveUpSlowestReader("a", kBegin + seconds(1), 2), std::nullopt);
  EXPECT_FALSE(call->given_up);
}

TEST(ActiveCallsTest, EndsTheCallOfAClientThatHasBeenIdleLongest) {
  ActiveCalls calls;
  const auto late = AddCall(calls, "a", std::nullopt), early = AddCall(calls, "a", std::nullopt);
  const auto other = AddCall(calls, "b", std::nullopt), busy = AddCall(calls, "a", std::nullopt);
  late->idle = kBegin + seconds(2);
  early->idle = kBegin + seconds(1);
  other->idle = kBegin;
  EXPECT_FALSE(calls.GiveUpLongestIdle("a", kBegin + seconds(2), 2)) << "not idle for long enough";
  EXPECT_TRUE(calls.GiveUpLongestIdle("a", kBegin + seconds(4), 2));
  EXPECT_TRUE(early->given_up);
  EXPECT_FALSE(late->given_up);
  EXPECT_TRUE(calls.GiveUpLongestIdle("a", kBegin + seconds(4), 2));
  EXPECT_TRUE(late->given_up);
  EXPECT_FALSE(calls.GiveUpLongestIdle("a", kBegin + seconds(4), 2));
  EXPECT_FALSE(other->given_up);
  EXPECT_FALSE(busy->given_up);
}

}  // namespace
}  // namespace duet::server::service

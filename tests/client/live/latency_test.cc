#include "client/live/latency.h"

#include "gtest/gtest.h"

namespace duet::client::live {
namespace {

const absl::Time kBegin = absl::UnixEpoch();

TEST(LatencyLogTest, PercentilesAreOfTheRequestedTime) {
  LatencyLog log;
  EXPECT_EQ(log.All().p50, absl::ZeroDuration());
  for (int i = 1; i <= 100; ++i) log.Add(kBegin + absl::Seconds(i), absl::Milliseconds(i));
  EXPECT_EQ(log.All().p50, absl::Milliseconds(50));
  EXPECT_EQ(log.All().p99, absl::Milliseconds(99));
  EXPECT_EQ(log.Since(kBegin + absl::Seconds(91)).p50, absl::Milliseconds(95));
  EXPECT_EQ(log.Since(kBegin + absl::Seconds(91)).p99, absl::Milliseconds(100));
  EXPECT_EQ(log.Since(kBegin + absl::Seconds(101)).p99, absl::ZeroDuration());
}

TEST(LatencyLogTest, OldFramesMakeRoomForNewOnes) {
  LatencyLog log;
  for (std::size_t i = 0; i < LatencyLog::kKept; ++i) log.Add(kBegin, absl::Milliseconds(1));
  for (std::size_t i = 0; i < LatencyLog::kKept / 2 + 1; ++i) {
    log.Add(kBegin + absl::Seconds(1), absl::Milliseconds(2));
  }
  EXPECT_EQ(log.All().p50, absl::Milliseconds(2));
  EXPECT_EQ(log.Since(kBegin + absl::Seconds(1)).p50, absl::Milliseconds(2));
}

}  // namespace
}  // namespace duet::client::live

#include "server/lifecycle/heap_trimmer.h"

#include <gtest/gtest.h>

namespace duet::server::lifecycle {
namespace {

constexpr std::size_t kMegabyte = std::size_t{1} << 20;

class HeapTrimmerTest : public ::testing::Test {
 protected:
  int trims_ = 0;
  HeapTrimmer trimmer_{[this] { ++trims_; }};
};

TEST_F(HeapTrimmerTest, LeavesAnIdleHeapAlone) {
  for (int i = 0; i < 3; ++i) trimmer_.Look(0, 0);
  EXPECT_EQ(trims_, 0);
}

TEST_F(HeapTrimmerTest, TrimsWhenLargeRequestsCameAndOnceMore) {
  trimmer_.Look(64 * kMegabyte, 0);
  EXPECT_EQ(trims_, 1);
  trimmer_.Look(64 * kMegabyte, 0);
  EXPECT_EQ(trims_, 2);
  trimmer_.Look(64 * kMegabyte, 0);
  EXPECT_EQ(trims_, 2);
}

TEST_F(HeapTrimmerTest, TrimsWhenTheCallThatHeldOneIsOver) {
  trimmer_.Look(32 * kMegabyte, 32 * kMegabyte);
  trimmer_.Look(32 * kMegabyte, 32 * kMegabyte);
  trimmer_.Look(32 * kMegabyte, 32 * kMegabyte);
  EXPECT_EQ(trims_, 2);
  trimmer_.Look(32 * kMegabyte, 0);
  EXPECT_EQ(trims_, 3);
}

TEST_F(HeapTrimmerTest, SmallRequestsAreNoReason) {
  trimmer_.Look(0, 9000);
  trimmer_.Look(0, 18000);
  trimmer_.Look(0, 0);
  EXPECT_EQ(trims_, 0);
}

TEST_F(HeapTrimmerTest, ManySmallOnesThatGoAre) {
  for (std::size_t held = 0; held <= 2 * kMegabyte; held += 9000) trimmer_.Look(0, held);
  EXPECT_EQ(trims_, 0);
  trimmer_.Look(0, 0);
  EXPECT_EQ(trims_, 1);
}

}  // namespace
}  // namespace duet::server::lifecycle

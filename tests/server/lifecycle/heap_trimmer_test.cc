#include "server/lifecycle/heap_trimmer.h"

#include <gtest/gtest.h>
#include <malloc.h>

#include <cstdlib>

namespace duet::server::lifecycle {
namespace {

constexpr std::size_t kMegabyte = std::size_t{1} << 20;

#if !defined(__SANITIZE_ADDRESS__)  // AddressSanitizer has a heap of its own.
// Whether a block of this size is mapped individually, so that freeing it returns it to the system.
bool IsMappedByItself(std::size_t bytes) {
  const std::size_t before = mallinfo2().hblks;
  void* const block = std::malloc(bytes);
  const bool mapped = mallinfo2().hblks > before;
  std::free(block);
  return mapped;
}

TEST(LimitFreeMemoryTest, LargeBlocksAreReturnedToTheSystem) {
  LimitFreeMemory();
  EXPECT_TRUE(IsMappedByItself(16 * kMegabyte));
  // By default the heap keeps blocks up to the largest size that it has seen freed.
  EXPECT_TRUE(IsMappedByItself(2 * kMegabyte));
  EXPECT_FALSE(IsMappedByItself(kMegabyte / 2));
}
#endif

class HeapTrimmerTest : public ::testing::Test {
 protected:
  int trims_ = 0;
  HeapTrimmer trimmer_{[this] { ++trims_; }};
};

TEST_F(HeapTrimmerTest, DoesNotTrimAnIdleHeap) {
  for (int i = 0; i < 3; ++i) trimmer_.Look(0, 0);
  EXPECT_EQ(trims_, 0);
}

TEST_F(HeapTrimmerTest, TrimsAfterLargeRequestsAndOnceMore) {
  trimmer_.Look(64 * kMegabyte, 0);
  EXPECT_EQ(trims_, 1);
  trimmer_.Look(64 * kMegabyte, 0);
  EXPECT_EQ(trims_, 2);
  trimmer_.Look(64 * kMegabyte, 0);
  EXPECT_EQ(trims_, 2);
}

TEST_F(HeapTrimmerTest, TrimsWhenACallReleasesALargeRequest) {
  trimmer_.Look(32 * kMegabyte, 32 * kMegabyte);
  trimmer_.Look(32 * kMegabyte, 32 * kMegabyte);
  trimmer_.Look(32 * kMegabyte, 32 * kMegabyte);
  EXPECT_EQ(trims_, 2);
  trimmer_.Look(32 * kMegabyte, 0);
  EXPECT_EQ(trims_, 3);
}

TEST_F(HeapTrimmerTest, DoesNotTrimForSmallRequests) {
  trimmer_.Look(0, 9000);
  trimmer_.Look(0, 18000);
  trimmer_.Look(0, 0);
  EXPECT_EQ(trims_, 0);
}

TEST_F(HeapTrimmerTest, TrimsWhenManySmallRequestsAreReleased) {
  for (std::size_t held = 0; held <= 2 * kMegabyte; held += 9000) trimmer_.Look(0, held);
  EXPECT_EQ(trims_, 0);
  trimmer_.Look(0, 0);
  EXPECT_EQ(trims_, 1);
}

}  // namespace
}  // namespace duet::server::lifecycle

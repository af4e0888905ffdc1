#include <gtest/gtest.h>
#include <malloc.h>

#include <cstdlib>

#include "server/lifecycle/process_end.h"

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

TEST(HeapTrimmerTest, TrimsAfterLargeRequestsAndAtTheirRelease) {
  int trims = 0;
  HeapTrimmer trimmer([&trims] { ++trims; });
  const struct {
    const char* what;
    std::size_t received_bytes, held_bytes;
    int trims;  // so far
  } steps[] = {
      {"idle", 0, 0, 0},
      {"small requests are held", 0, 18000, 0},
      {"and released", 0, 0, 0},
      {"a large request arrives", 32 * kMegabyte, 32 * kMegabyte, 1},
      {"once more", 32 * kMegabyte, 32 * kMegabyte, 2},
      {"it is being answered", 32 * kMegabyte, 32 * kMegabyte, 2},
      {"it is released", 32 * kMegabyte, 0, 3},
      {"once more", 32 * kMegabyte, 0, 4},
      {"idle", 32 * kMegabyte, 0, 4},
      {"another arrives and is released", 64 * kMegabyte, 0, 5},
  };
  for (const auto& [what, received_bytes, held_bytes, expected] : steps) {
    trimmer.Look(received_bytes, held_bytes);
    EXPECT_EQ(trims, expected) << what;
  }
}

TEST(HeapTrimmerTest, TrimsWhenManySmallRequestsAreReleased) {
  int trims = 0;
  HeapTrimmer trimmer([&trims] { ++trims; });
  for (std::size_t held = 0; held <= 2 * kMegabyte; held += 9000) trimmer.Look(0, held);
  EXPECT_EQ(trims, 0);
  trimmer.Look(0, 0);
  EXPECT_EQ(trims, 1);
}

}  // namespace
}  // namespace duet::server::lifecycle

#include "server/lifecycle/process_end.h"

#include <gtest/gtest.h>
#include <malloc.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>

namespace duet::server::lifecycle {
namespace {

TEST(StopSignalTest, SeesSignalsThatCameWhileNobodyWaited) {
  StopSignal stop;
  EXPECT_FALSE(stop.WaitFor(0));
  EXPECT_FALSE(stop.WaitFor(0.001));
  for (const int signal : {SIGTERM, SIGINT}) {
    kill(getpid(), signal);
    EXPECT_TRUE(stop.WaitFor(60));
    EXPECT_FALSE(stop.WaitFor(0)) << "each signal counts once";
  }
}

TEST(StopSignalTest, TellsReloadsFromStops) {
  StopSignal stop;
  kill(getpid(), SIGHUP);
  EXPECT_FALSE(stop.WaitFor(0)) << "a reload stops nothing";
  EXPECT_EQ(stop.Wait(), StopSignal::Kind::kReload);
  kill(getpid(), SIGHUP);
  kill(getpid(), SIGHUP);
  kill(getpid(), SIGTERM);
  EXPECT_EQ(stop.Wait(), StopSignal::Kind::kStop) << "before the reload that came first";
  EXPECT_EQ(stop.Wait(), StopSignal::Kind::kReload);
  EXPECT_FALSE(stop.WaitFor(0));
}

TEST(StopSignalDeathTest, EndsAProcessThatDoesNotExitInTime) {
  EXPECT_EXIT(
      {
        StopSignal stop;
        stop.AllowToStop(0.01);
        kill(getpid(), SIGTERM);
        while (true) pause();
      },
      testing::ExitedWithCode(kExitLate), "\"event\":\"stopped_late\".*\"exit_code\":4}");
}

TEST(LastResortDeathTest, EndsAProcessUnlessItIsSetAgain) {
  EXPECT_EXIT(
      {
        LastResort unused("unused", "", 1);
        unused.Set(0.01);
        unused.Set(0);
        LastResort used("used", "too late", 7);
        used.Set(3600);
        used.Set(0.05);
        while (true) pause();
      },
      testing::ExitedWithCode(7), "\"event\":\"used\",\"message\":\"too late\"");
}

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

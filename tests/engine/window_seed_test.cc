#include "model/engine/window_seed.h"

#include <limits>
#include <set>

#include "gtest/gtest.h"

namespace duet::engine {
namespace {

TEST(WindowSeed, TheFirstWindowHasTheRequestsOwn) {
  for (uint64_t seed : {uint64_t{0}, uint64_t{7}, std::numeric_limits<uint64_t>::max()}) {
    EXPECT_EQ(WindowSeed(seed, 0), seed);
  }
}

TEST(WindowSeed, LaterWindowsFollowThePublishedStream) {
  // The first numbers of SplitMix64 that begins at 1234567, as published with its reference code.
  EXPECT_EQ(WindowSeed(1234567, 1), 6457827717110365317u);
  EXPECT_EQ(WindowSeed(1234567, 2), 3203168211198807973u);
  EXPECT_EQ(WindowSeed(1234567, 3), 9817491932198370423u);
}

TEST(WindowSeed, NoTwoWindowsOfNeighbouringSeedsShareOne) {
  std::set<uint64_t> seeds;
  for (uint64_t seed = 0; seed < 100; ++seed) {
    for (int window = 0; window < 300; ++window) seeds.insert(WindowSeed(seed, window));
  }
  EXPECT_EQ(seeds.size(), 100u * 300u);
}

}  // namespace
}  // namespace duet::engine

#include "model/engine/window_seed.h"

#include <limits>
#include <set>

#include "gmock/gmock.h"

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

TEST(LeaderSeed, DiffersBetweenLeadersAndNotBetweenPlaces) {
  motion::Poses leader(30, 2);
  for (int t = 0; t < 30; ++t) leader.at(t, 1) = {0.1f * static_cast<float>(t), 1.03f, 0};
  const uint64_t seed = LeaderSeed(leader, 15, {});
  EXPECT_LT(seed, uint64_t{1} << 32);
  motion::Poses turned = leader;
  for (motion::Vec3& joint : turned.all()) joint = RotateY(joint, 1) + motion::Vec3{3, 0, -2};
  EXPECT_EQ(LeaderSeed(turned, 15, {}), seed);
  motion::Poses faster = leader;
  for (motion::Vec3& joint : faster.all()) joint.x *= 1.1f;
  EXPECT_NE(LeaderSeed(faster, 15, {}), seed);
  EXPECT_NE(LeaderSeed(leader, 12, {}), seed) << "the clip is longer";
  EXPECT_THAT((std::vector<uint64_t>{5, 7}), testing::Contains(LeaderSeed(leader, 15, {5, 7})));
  EXPECT_EQ(LeaderSeed(leader, 15, {7}), 7u);
}

}  // namespace
}  // namespace duet::engine

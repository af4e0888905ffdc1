#include "model/engine/resting_leader.h"

#include "gtest/gtest.h"
#include "tests/support/sample_motion.h"

namespace duet::engine {
namespace {

// A person who walks along x at `speed` metres per second, at 30 frames per second.
motion::Poses Walking(float speed) {
  const motion::Poses pose = test::SwayingMotion(1, 15);
  motion::Poses walking(0, 15);
  for (int t = 0; t < 5; ++t) {
    motion::Poses frame = pose;
    for (motion::Vec3& p : frame.all()) p.x += speed * static_cast<float>(t) / 30;
    walking.Append(frame.all());
  }
  return walking;
}

// How far the root of a walking leader is taken to go after its last known frame.
float WayAfter(float speed, double seconds) {
  const motion::Poses known = Walking(speed);
  const motion::Poses resting = ComeToRest(motion::SbuSkeleton(), known, 30, {seconds});
  const int root = motion::SbuSkeleton().root;
  return resting.at(0, root).x - known.at(4, root).x;
}

TEST(ComeToRest, ALeaderWhoStandsGoesOnStanding) { EXPECT_NEAR(WayAfter(0, 1), 0, 1e-5); }

// 1.3 and 0.3 s are constants of resting_leader.cc.
TEST(ComeToRest, ALeaderWhoMovesIsFasterAtFirstAndComesToRest) {
  EXPECT_NEAR(WayAfter(1, 0.01), 0.013, 5e-4);
  EXPECT_NEAR(WayAfter(1, 2), 1.3 * 0.3, 1e-3);
  EXPECT_NEAR(WayAfter(1, 60), 1.3 * 0.3, 1e-3);
}

TEST(ComeToRest, OneKnownFrameIsHeld) {
  const motion::Poses known = test::SwayingMotion(1, 15);
  const motion::Poses resting = ComeToRest(motion::SbuSkeleton(), known, 30, {0.5});
  for (int j = 0; j < 15; ++j) EXPECT_LT(Distance(resting.at(0, j), known.at(0, j)), 1e-4f) << j;
}

}  // namespace
}  // namespace duet::engine

#include "model/motion/beat.h"

#include "gmock/gmock.h"
#include "tests/support/matchers.h"

namespace duet::motion {
namespace {

TEST(BeatTest, PositionsCountFromTheFirstBeat) {
  const Beat beat{120, 0.25};
  EXPECT_DOUBLE_EQ(beat.period_seconds(), 0.5);
  EXPECT_DOUBLE_EQ(beat.SecondsAt(0), 0.25);
  EXPECT_DOUBLE_EQ(beat.SecondsAt(3.5), 2);
}

TEST(BeatTimesTest, ReachFromTheFirstBeatToTheEnd) {
  EXPECT_THAT(BeatTimes({120, -0.1}, 1), ElementsAre(-0.1, 0.4, 0.9, DoubleEq(1.4)));
  EXPECT_THAT(BeatTimes({60, 0}, 2), ElementsAre(0, 1, 2));
  EXPECT_THAT(BeatTimes({60, 5}, 2), ElementsAre(5));
}

}  // namespace
}  // namespace duet::motion

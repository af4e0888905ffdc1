#include <gtest/gtest.h>

#include "server/watchdog/step_watch.h"

namespace duet::server::watchdog {
namespace {

constexpr double kStop = 40;
constexpr double kHurry = 10;

TEST(StopDeadlineTest, NeverExpiresWithoutASignal) {
  StopDeadline deadline;
  deadline.Pass(1e9);
  EXPECT_FALSE(deadline.asked());
  EXPECT_FALSE(deadline.IsOver(0, 0));
}

TEST(StopDeadlineTest, FirstSignalAllowsDrainAndGrace) {
  StopDeadline deadline;
  deadline.Pass(1000);
  deadline.Asked();
  deadline.Pass(39);
  EXPECT_FALSE(deadline.IsOver(kStop, kHurry));
  deadline.Pass(1);
  EXPECT_TRUE(deadline.IsOver(kStop, kHurry));
}

TEST(StopDeadlineTest, SecondSignalShortensTheDeadline) {
  StopDeadline deadline;
  deadline.Asked();
  deadline.Pass(5);
  deadline.Asked();
  deadline.Pass(9);
  EXPECT_FALSE(deadline.IsOver(kStop, kHurry));
  deadline.Pass(1);
  EXPECT_TRUE(deadline.IsOver(kStop, kHurry));
}

TEST(StopDeadlineTest, FurtherSignalsDoNotExtendTheDeadline) {
  StopDeadline deadline;
  for (int i = 0; i < 11; ++i) {
    deadline.Asked();
    deadline.Pass(1);
  }
  EXPECT_TRUE(deadline.IsOver(kStop, kHurry)) << "ten seconds since the second";
}

TEST(StopDeadlineTest, SecondSignalDoesNotExtendTheDeadline) {
  StopDeadline deadline;
  deadline.Asked();
  deadline.Pass(39);
  deadline.Asked();
  deadline.Pass(1);
  EXPECT_TRUE(deadline.IsOver(kStop, kHurry));
}

}  // namespace
}  // namespace duet::server::watchdog

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>

#include "server/lifecycle/process_end.h"

namespace duet::test {
namespace {

using server::lifecycle::kExitLate;
using server::lifecycle::LastResort;
using server::lifecycle::StopSignal;

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

}  // namespace
}  // namespace duet::test

#include "server/lifecycle/stop_signal.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>

namespace duet::test {
namespace {

// No other thread may run in this program: it would take the signals.

TEST(StopSignalTest, SeesNothingBeforeASignal) {
  server::lifecycle::StopSignal stop;
  EXPECT_FALSE(stop.WaitFor(0));
  EXPECT_FALSE(stop.WaitFor(0.001));
}

TEST(StopSignalTest, SeesSignalsThatCameWhileNobodyWaited) {
  server::lifecycle::StopSignal stop;
  for (const int signal : {SIGTERM, SIGINT}) {
    kill(getpid(), signal);
    EXPECT_TRUE(stop.WaitFor(60));
    EXPECT_FALSE(stop.WaitFor(0)) << "each signal counts once";
  }
}

TEST(StopSignalTest, WaitEndsWithASignal) {
  server::lifecycle::StopSignal stop;
  kill(getpid(), SIGTERM);
  stop.Wait();
  EXPECT_FALSE(stop.WaitFor(0));
}

TEST(StopSignalTest, TellsReloadsFromStops) {
  using server::lifecycle::StopSignal;
  StopSignal stop;
  kill(getpid(), SIGHUP);
  EXPECT_FALSE(stop.WaitFor(0)) << "a reload stops nothing";
  EXPECT_EQ(stop.Wait(), StopSignal::Kind::kReload);
  kill(getpid(), SIGHUP);
  kill(getpid(), SIGTERM);
  EXPECT_EQ(stop.Wait(), StopSignal::Kind::kStop) << "before the reload that came first";
  EXPECT_EQ(stop.Wait(), StopSignal::Kind::kReload);
}

}  // namespace
}  // namespace duet::test

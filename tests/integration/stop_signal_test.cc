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

}  // namespace
}  // namespace duet::test

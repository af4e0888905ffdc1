#include "server/watchdog/stop_signal.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>

#include "server/watchdog/watchdog.h"

namespace duet::test {
namespace {

using server::watchdog::StopSignal;
using server::watchdog::Watchdog;

TEST(StopSignalTest, SeesNothingBeforeASignal) {
  StopSignal stop;
  EXPECT_FALSE(stop.WaitFor(0));
  EXPECT_FALSE(stop.WaitFor(0.001));
}

TEST(StopSignalTest, SeesSignalsThatCameWhileNobodyWaited) {
  StopSignal stop;
  const Watchdog watchdog({}, stop);
  for (const int signal : {SIGTERM, SIGINT}) {
    kill(getpid(), signal);
    EXPECT_TRUE(stop.WaitFor(60));
    EXPECT_FALSE(stop.WaitFor(0)) << "each signal counts once";
  }
}

TEST(StopSignalTest, SeesSignalsFromBeforeTheWatchdog) {
  StopSignal stop;
  kill(getpid(), SIGTERM);
  const Watchdog watchdog({}, stop);
  EXPECT_TRUE(stop.WaitFor(60));
}

TEST(StopSignalTest, WaitEndsWithASignal) {
  StopSignal stop;
  const Watchdog watchdog({}, stop);
  kill(getpid(), SIGTERM);
  EXPECT_EQ(stop.Wait(), StopSignal::Kind::kStop);
  EXPECT_FALSE(stop.WaitFor(0));
  kill(getpid(), SIGHUP);
  EXPECT_EQ(stop.Wait(), StopSignal::Kind::kReload);
}

TEST(StopSignalTest, TellsReloadsFromStops) {
  StopSignal stop;
  stop.Note(StopSignal::Kind::kReload);
  EXPECT_FALSE(stop.WaitFor(0)) << "a reload stops nothing";
  EXPECT_EQ(stop.Wait(), StopSignal::Kind::kReload);
  stop.Note(StopSignal::Kind::kReload);
  stop.Note(StopSignal::Kind::kReload);
  stop.Note(StopSignal::Kind::kStop);
  EXPECT_EQ(stop.Wait(), StopSignal::Kind::kStop) << "before the reload that came first";
  EXPECT_EQ(stop.Wait(), StopSignal::Kind::kReload);
  EXPECT_FALSE(stop.WaitFor(0));
}

}  // namespace
}  // namespace duet::test

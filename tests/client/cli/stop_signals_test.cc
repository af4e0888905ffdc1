#include "client/cli/stop_signals.h"

#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "absl/synchronization/notification.h"
#include "client/cli/command.h"
#include "gtest/gtest.h"

namespace duet::client::cli {
namespace {

constexpr int kEndedInOrder = 7;

// Sends a signal to this process, and returns when it was read.
void SendAndWait(int signal) {
  kill(getpid(), signal);
  sigset_t pending;
  do {
    std::this_thread::yield();
    sigpending(&pending);
  } while (sigismember(&pending, signal) == 1);
}

// Stops twice and exits in order.
[[noreturn]] void StopTwice(std::chrono::nanoseconds one_stop) {
  {
    absl::Notification stopped;
    const StopSignals signals([&stopped] { stopped.Notify(); }, one_stop);
    kill(getpid(), SIGINT);
    stopped.WaitForNotification();
    SendAndWait(SIGTERM);
  }
  _exit(kEndedInOrder);
}

class StopSignalsDeathTest : public ::testing::Test {
 protected:
  void SetUp() override { GTEST_FLAG_SET(death_test_style, "threadsafe"); }
};

TEST_F(StopSignalsDeathTest, SignalsOfOneStopEndTheProcessInOrder) {
  EXPECT_EXIT(StopTwice(std::chrono::hours(1)), ::testing::ExitedWithCode(kEndedInOrder), "");
}

TEST_F(StopSignalsDeathTest, LaterSignalEndsTheProcessAtOnce) {
  EXPECT_EXIT(StopTwice(std::chrono::nanoseconds(-1)), ::testing::ExitedWithCode(kExitRetry), "");
}

}  // namespace
}  // namespace duet::client::cli

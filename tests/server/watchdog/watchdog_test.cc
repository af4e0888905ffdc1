#include "server/watchdog/watchdog.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <string>
#include <thread>

#include "server/common/mutex.h"
#include "server/watchdog/exit_codes.h"
#include "tests/support/matchers.h"

namespace duet::server::watchdog {
namespace {

using ::testing::ExitedWithCode;

constexpr common::StepKind kWorking{"tester", "working for ever"};
constexpr common::StepKind kLoading{"loader", "reading for ever", /*is_bounded=*/false};

constexpr double kSoon = 0.05;
constexpr double kNever = 1e6;

[[noreturn]] void WaitForEver() {
  while (true) pause();
}

// Starts a thread that holds a lock and never returns. Waits until the thread has begun the
// step.
void BlockIn(const common::StepKind& kind) {
  static std::atomic<int> begun{0};
  const int before = begun;
  std::thread([&kind] {
    common::Mutex& mutex = *new common::Mutex;
    const common::MutexLock lock(mutex);
    const common::Step step(kind);
    ++begun;
    WaitForEver();
  }).detach();
  while (begun == before) std::this_thread::yield();
}

// Each test ends a process of its own, in which no other thread has started.
class WatchdogDeathTest : public ::testing::Test {
 protected:
  void SetUp() override { GTEST_FLAG_SET(death_test_style, "threadsafe"); }

  // The process under test, without the event that ends it. Nothing is destroyed.
  static Watchdog& Begin(const WatchdogOptions& options) {
    stop = new StopSignal;
    return *new Watchdog(options, *stop);
  }
  static WatchdogOptions Options(double step_seconds, double hurry_seconds, bool text = false) {
    WatchdogOptions options;
    options.step_seconds = step_seconds;
    options.hurry_seconds = hurry_seconds;
    options.text_log = text;
    return options;
  }

  static inline StopSignal* stop = nullptr;
};

TEST_F(WatchdogDeathTest, StuckThreadEndsTheProcess) {
  const auto process = [] {
    Begin(Options(kSoon, kNever));
    common::ProcessVitals().calls = 3;
    BlockIn(kWorking);
    WaitForEver();
  };
  EXPECT_EXIT(process(), ExitedWithCode(kExitStuck),
              AllOf(HasSubstr(R"("severity":"ERROR","event":"thread_stuck","thread":"tester")"),
                    HasSubstr(R"("doing":"working for ever","seconds":0.)"),
                    HasSubstr(R"("event":"stuck",)"), HasSubstr(R"("calls":3,)"),
                    HasSubstr("\"exit_code\":3}\n")));
}

TEST_F(WatchdogDeathTest, TextLogHasNoJson) {
  const auto process = [] {
    Begin(Options(kSoon, kNever, /*text=*/true));
    BlockIn(kWorking);
    WaitForEver();
  };
  EXPECT_EXIT(process(), ExitedWithCode(kExitStuck),
              AllOf(ContainsRegex("Z ERROR   thread_stuck thread=tester thread_id=[0-9]+ "
                                  "doing=\"working for ever\" seconds=0"),
                    HasSubstr(" exit_code=3\n")));
}

TEST_F(WatchdogDeathTest, EndsEvenIfNobodyReadsTheLog) {
  const auto process = [] {
    int ends[2];
    if (pipe(ends) != 0 || dup2(ends[1], STDERR_FILENO) < 0) std::abort();
    fcntl(STDERR_FILENO, F_SETFL, O_NONBLOCK);
    const std::string page(4096, ' ');
    while (write(STDERR_FILENO, page.data(), page.size()) > 0) {
    }
    fcntl(STDERR_FILENO, F_SETFL, 0);
    Begin(Options(kSoon, kNever));
    BlockIn(kWorking);
    WaitForEver();
  };
  EXPECT_EXIT(process(), ExitedWithCode(kExitStuck), "");
}

TEST_F(WatchdogDeathTest, EndsAProcessThatDoesNotStopInTime) {
  const auto process = [] {
    Begin(Options(/*step_seconds=*/0, kSoon));
    BlockIn(kLoading);
    kill(getpid(), SIGTERM);
    WaitForEver();
  };
  EXPECT_EXIT(process(), ExitedWithCode(kExitLate),
              AllOf(HasSubstr(R"("event":"thread_at_work","thread":"loader")"),
                    HasSubstr(R"("event":"stopped_late")"), HasSubstr("\"exit_code\":4}\n")));
}

TEST_F(WatchdogDeathTest, SecondSignalShortensTheTimeToStop) {
  const auto process = [] {
    Begin(Options(/*step_seconds=*/0, kSoon)).AllowToStop(kNever);
    for (int i = 0; i < 2; ++i) {
      kill(getpid(), SIGTERM);
      if (!stop->WaitFor(60)) std::abort();
    }
    WaitForEver();
  };
  EXPECT_EXIT(process(), ExitedWithCode(kExitLate), HasSubstr("stopped_late"));
}

TEST_F(WatchdogDeathTest, UnboundedStepsAreNeverStuck) {
  const auto process = [] {
    Begin(Options(kSoon, kNever));
    BlockIn(kLoading);
    std::thread([] {
      const common::Step step(kWorking);
      const common::Idle idle;
      WaitForEver();
    }).detach();
    BlockIn(kWorking);  // ends it
    WaitForEver();
  };
  EXPECT_EXIT(process(), ExitedWithCode(kExitStuck),
              AllOf(HasSubstr(R"("thread":"tester")"), HasSubstr(R"("threads":1,)"),
                    ::testing::Not(HasSubstr("loader"))));
}

TEST(WatchdogTest, DestroyedWatchdogDoesNotEndTheProcess) {
  StopSignal stop;
  const Watchdog watchdog({}, stop);
}

}  // namespace
}  // namespace duet::server::watchdog

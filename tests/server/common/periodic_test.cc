#include "server/common/periodic.h"

#include <gtest/gtest.h>

namespace duet::server::common {
namespace {

// How often something was done, for a test to wait on.
class Counter {
 public:
  void Count() {
    MutexLock lock(mutex_);
    ++count_;
    changed_.NotifyAll();
  }
  void WaitFor(int count) {
    MutexLock lock(mutex_);
    while (count_ < count) changed_.Wait(mutex_);
  }
  int count() {
    MutexLock lock(mutex_);
    return count_;
  }

 private:
  Mutex mutex_;
  CondVar changed_;
  int count_ DUET_GUARDED_BY(mutex_) = 0;
};

TEST(PeriodicTest, WorksAgainAndAgainUntilDestroyed) {
  Counter counter;
  {
    const Periodic periodic(std::chrono::milliseconds(1), [&] { counter.Count(); });
    counter.WaitFor(3);
  }
  const int done = counter.count();
  EXPECT_GE(done, 3);
  EXPECT_EQ(counter.count(), done);
}

TEST(PeriodicTest, EndsWithoutWaitingForItsInterval) {
  Counter counter;
  {
    const Periodic periodic(std::chrono::hours(24), [&] { counter.Count(); });
  }
  EXPECT_EQ(counter.count(), 0);
}

}  // namespace
}  // namespace duet::server::common

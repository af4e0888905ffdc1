#ifndef DUET_SERVER_COMMON_PERIODIC_H_
#define DUET_SERVER_COMMON_PERIODIC_H_

#include <chrono>
#include <functional>
#include <thread>

#include "server/common/mutex.h"

namespace duet::server::common {

// Does something again and again on a thread of its own, for the first time after one interval,
// until it is destroyed: housekeeping that may touch files. What it does must not throw.
class Periodic {
 public:
  Periodic(std::chrono::milliseconds interval, std::function<void()> work);
  // Waits for the work that is being done.
  ~Periodic();
  Periodic(const Periodic&) = delete;
  Periodic& operator=(const Periodic&) = delete;

 private:
  void Run();

  const std::chrono::milliseconds interval_;
  const std::function<void()> work_;
  Mutex mutex_;
  CondVar stopped_;
  bool stop_ DUET_GUARDED_BY(mutex_) = false;
  std::thread thread_;  // the last member: it uses the others
};

}  // namespace duet::server::common

#endif  // DUET_SERVER_COMMON_PERIODIC_H_

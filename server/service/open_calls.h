#ifndef DUET_SERVER_SERVICE_OPEN_CALLS_H_
#define DUET_SERVER_SERVICE_OPEN_CALLS_H_

#include "server/common/mutex.h"

namespace duet::server::service {

// Counts the calls that gRPC has not finished. Their status may not have been sent yet.
//
// Threads: safe to call concurrently.
class OpenCalls {
 public:
  // Counts one call during its lifetime.
  class Ticket {
   public:
    explicit Ticket(OpenCalls& calls) : calls_(calls) { calls_.Add(1); }
    ~Ticket() { calls_.Add(-1); }
    Ticket(const Ticket&) = delete;
    Ticket& operator=(const Ticket&) = delete;

   private:
    OpenCalls& calls_;
  };

  // Waits until there are none, at most `seconds`.
  void WaitForNone(double seconds);

 private:
  void Add(int calls);

  common::Mutex mutex_;
  common::CondVar changed_;
  int open_ DUET_GUARDED_BY(mutex_) = 0;
};

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_OPEN_CALLS_H_

#ifndef DUET_SERVER_SERVICE_ADMISSION_H_
#define DUET_SERVER_SERVICE_ADMISSION_H_

#include <cstddef>
#include <utility>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/batching/priority.h"
#include "server/common/mutex.h"

namespace duet::server::service {

class Admission;

// Holds one of the places for calls being answered; its destructor gives the place back.
class AdmissionSlot {
 public:
  AdmissionSlot() = default;
  AdmissionSlot(AdmissionSlot&& other) noexcept
      : admission_(std::exchange(other.admission_, nullptr)) {}
  AdmissionSlot& operator=(AdmissionSlot&& other) noexcept {
    std::swap(admission_, other.admission_);
    return *this;
  }
  ~AdmissionSlot();

 private:
  friend class Admission;
  explicit AdmissionSlot(Admission* admission) : admission_(admission) {}
  Admission* admission_ = nullptr;
};

// Decides whether the server takes one more Synthesize call.
//
// Threads: safe to call concurrently.
class Admission {
 public:
  enum class State { kLoading, kServing, kDraining };

  // `max_calls`: calls answered at the same time, 1 or more; bulk calls may fill their share of it.
  explicit Admission(std::size_t max_calls) : max_calls_(max_calls) {}

  void SetState(State state);
  State state() const;

  // Whether new calls are answered at all: UNAVAILABLE with RetryInfo while loading or draining.
  absl::Status CheckServing() const;

  // UNAVAILABLE as above; RESOURCE_EXHAUSTED with RetryInfo when there are too many calls.
  // The slot must not outlive the admission.
  absl::StatusOr<AdmissionSlot> Admit(batching::Priority priority);

  std::size_t calls() const;

 private:
  friend class AdmissionSlot;
  void Leave();

  const std::size_t max_calls_;
  mutable common::Mutex mutex_;
  State state_ DUET_GUARDED_BY(mutex_) = State::kLoading;
  std::size_t calls_ DUET_GUARDED_BY(mutex_) = 0;
};

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_ADMISSION_H_

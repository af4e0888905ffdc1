#ifndef DUET_CONTRIB_LOAD_TARGET_H_
#define DUET_CONTRIB_LOAD_TARGET_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "absl/status/status.h"
#include "contrib/load/time.h"

namespace duet::contrib::load {

// How a call ended.
struct EndedCall {
  int64_t id = 0;
  absl::StatusCode code = absl::StatusCode::kOk;
  std::optional<Time> first_chunk;  // arrival of its first frames
  Time end;
  int frames = 0;  // received
};

// The destination of calls and the source of time. Tests use a simulated server, which makes a run
// of minutes a function of its seed.
//
// Threads: not thread-safe.
class Target {
 public:
  virtual ~Target() = default;

  virtual Time Now() const = 0;
  // Begins a call of a kind (an index into the target's kinds) without waiting for it. Every call
  // ends exactly once. The caller chooses `id`.
  virtual void Start(int64_t id, std::size_t kind) = 0;
  // Waits until `until` or until calls have ended, whichever is first. Returns the ended calls that
  // no earlier Wait returned.
  virtual std::vector<EndedCall> Wait(Time until) = 0;
  // Cancels all calls in flight; Wait returns them too.
  virtual void CancelAll() = 0;
};

}  // namespace duet::contrib::load

#endif  // DUET_CONTRIB_LOAD_TARGET_H_

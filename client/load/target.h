#ifndef DUET_CLIENT_LOAD_TARGET_H_
#define DUET_CLIENT_LOAD_TARGET_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "absl/status/status.h"
#include "client/load/time.h"

namespace duet::client::load {

// How a call ended.
struct EndedCall {
  int64_t id = 0;
  absl::StatusCode code = absl::StatusCode::kOk;
  std::optional<Time> first_chunk;  // when its first frames came
  Time end;
  int frames = 0;  // that came
};

// Where calls go and where time comes from. Tests put a simulated server in its place, so that a
// run of minutes is a function of its seed.
//
// Threads: used by one.
class Target {
 public:
  virtual ~Target() = default;

  virtual Time Now() const = 0;
  // Begins a call of a kind (an index into what the target knows) and does not wait for it. Every
  // call that is begun ends, once. `id` is the caller's.
  virtual void Start(int64_t id, std::size_t kind) = 0;
  // Waits until `until` or until calls have ended, whichever is first; the calls that have ended
  // and were not told of before.
  virtual std::vector<EndedCall> Wait(Time until) = 0;
  // Has all calls end that have not; Wait tells of them too.
  virtual void CancelAll() = 0;
};

}  // namespace duet::client::load

#endif  // DUET_CLIENT_LOAD_TARGET_H_

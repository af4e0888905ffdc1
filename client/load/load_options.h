#ifndef DUET_CLIENT_LOAD_LOAD_OPTIONS_H_
#define DUET_CLIENT_LOAD_LOAD_OPTIONS_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "client/load/arrivals.h"
#include "client/load/measurement.h"
#include "client/load/time.h"

namespace duet::client::load {

struct LoadOptions {
  // How often each of the target's kinds of call is drawn; one or more.
  std::vector<double> kind_weights = {1};
  ArrivalKind arrivals = ArrivalKind::kPoisson;
  uint64_t seed = 0;
  Duration warm_up = std::chrono::seconds(1);  // calls due before it is over are not measured
  Duration measured = std::chrono::seconds(10);
  int64_t calls = 0;  // where above 0, so many are measured, however long that takes
  // Of an open loop: no more calls than these are under way; those due meanwhile are sent late,
  // and measured from when they were due.
  int max_in_flight = 4096;
  // Callers who ask for `background_kind` all the time and are not measured.
  int background_callers = 0;
  std::size_t background_kind = 0;
  Duration interval = std::chrono::seconds(1);  // of the timeline
  // Told of every call that is not background, in the order in which they ended. Optional.
  std::function<void(const CallRecord&)> on_record;
  // Looked at all the time: no further call is sent once it says so, and what was sent until then
  // is what was measured. Optional.
  std::function<bool()> stopped;
};

}  // namespace duet::client::load

#endif  // DUET_CLIENT_LOAD_LOAD_OPTIONS_H_

#ifndef DUET_CONTRIB_LOAD_LOAD_OPTIONS_H_
#define DUET_CONTRIB_LOAD_LOAD_OPTIONS_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "contrib/load/arrivals.h"
#include "contrib/load/measurement.h"
#include "contrib/load/time.h"

namespace duet::contrib::load {

struct LoadOptions {
  // The weight of each of the target's kinds of call; at least one.
  std::vector<double> kind_weights = {1};
  ArrivalKind arrivals = ArrivalKind::kPoisson;
  uint64_t seed = 0;
  Duration warm_up = std::chrono::seconds(1);  // calls that are due before its end are not measured
  Duration measured = std::chrono::seconds(10);
  int64_t calls = 0;  // if above 0, the number of measured calls, independent of time
  // In an open loop: the most calls in flight. Calls due beyond that are sent late and measured
  // from their due time.
  int max_in_flight = 4096;
  // Callers that call `background_kind` continuously and are not measured.
  int background_callers = 0;
  std::size_t background_kind = 0;
  Duration interval = std::chrono::seconds(1);  // of the timeline
  // Receives every call except background calls, in the order in which they ended. Optional.
  std::function<void(const CallRecord&)> on_record;
  // Polled: after it returns true no further call is sent, and only the calls sent until then are
  // measured. Optional.
  std::function<bool()> stopped;
};

}  // namespace duet::contrib::load

#endif  // DUET_CONTRIB_LOAD_LOAD_OPTIONS_H_

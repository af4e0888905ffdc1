#ifndef DUET_CONTRIB_LOAD_RECORDER_H_
#define DUET_CONTRIB_LOAD_RECORDER_H_

#include <cstddef>
#include <cstdint>
#include <functional>

#include "absl/status/status.h"
#include "contrib/load/load_options.h"
#include "contrib/load/measurement.h"
#include "contrib/load/target.h"
#include "contrib/load/time.h"

namespace duet::contrib::load {

// Builds a measurement from calls. Ignores calls due before `measured_from`.
class Recorder {
 public:
  // `options` outlives the recorder.
  Recorder(const Step& step, const LoadOptions& options, Time measured_from);

  // Counts a due call, even if it is never sent.
  void Due(Time due);
  void Ended(Time due, Time sent, std::size_t kind, const EndedCall& ended);
  void BackgroundEnded(absl::StatusCode code) { ++measurement_.background[code]; }

  // Calls that end later do not count in rates.
  void CloseAt(Time end) { answered_until_ = end; }
  int64_t measured_due() const { return measurement_.due; }
  // The measurement over `seconds` seconds.
  Measurement Finish(double seconds);

 private:
  Interval& IntervalOf(Time due);

  const std::function<void(const CallRecord&)>& on_record_;
  const Time measured_from_;
  Time answered_until_;
  Measurement measurement_;
};

}  // namespace duet::contrib::load

#endif  // DUET_CONTRIB_LOAD_RECORDER_H_

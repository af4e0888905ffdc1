#ifndef DUET_CLIENT_LOAD_RECORDER_H_
#define DUET_CLIENT_LOAD_RECORDER_H_

#include <cstddef>
#include <cstdint>
#include <functional>

#include "absl/status/status.h"
#include "client/load/load_options.h"
#include "client/load/measurement.h"
#include "client/load/target.h"
#include "client/load/time.h"

namespace duet::client::load {

// Makes a measurement of calls. Those due before `measured_from` are not measured.
class Recorder {
 public:
  // `options` outlives the recorder.
  Recorder(const Step& step, const LoadOptions& options, Time measured_from);

  // A call is due, whether or not it is ever sent.
  void Due(Time due);
  void Ended(Time due, Time sent, std::size_t kind, const EndedCall& ended);
  void BackgroundEnded(absl::StatusCode code) { ++measurement_.background[code]; }

  // Calls that end later than this count in no rate.
  void CloseAt(Time end) { answered_until_ = end; }
  int64_t measured_due() const { return measurement_.due; }
  // What was measured in so many seconds.
  Measurement Finish(double seconds);

 private:
  Interval& IntervalOf(Time due);

  const std::function<void(const CallRecord&)>& on_record_;
  const Time measured_from_;
  Time answered_until_;
  Measurement measurement_;
};

}  // namespace duet::client::load

#endif  // DUET_CLIENT_LOAD_RECORDER_H_

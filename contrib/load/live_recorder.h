#ifndef DUET_CONTRIB_LOAD_LIVE_RECORDER_H_
#define DUET_CONTRIB_LOAD_LIVE_RECORDER_H_

#include <optional>
#include <vector>

#include "contrib/load/live_measurement.h"
#include "contrib/load/live_options.h"
#include "contrib/load/live_schedule.h"
#include "contrib/load/live_target.h"

namespace duet::contrib::load {

// Builds a measurement from what was sent and what arrived.
class LiveRecorder {
 public:
  // `options` outlives the recorder.
  LiveRecorder(const LiveOptions& options, Time measured_from);

  void Opened(int session, Time time);
  // A frame whose time has come: sent at `now`, or lost.
  void Sent(int session, const LiveSchedule::Frame& frame, Time now);
  void Arrived(const LiveEvent& event);
  // The measurement. Every session has ended.
  LiveMeasurement Finish(double seconds);

 private:
  struct Session {
    Time opened;
    std::vector<std::optional<Time>> due;  // of each frame that was sent or lost; absent: lost
    int received = 0;                      // final frames, without doubled ones
    bool ended = false;
  };
  void Receive(int session, int frame, Time time);
  void End(Session* session, const EndedSession& ended);
  bool IsMeasured(Time due) const { return due >= measured_from_ && due < measured_until_; }
  LiveInterval& IntervalOf(Time due);

  const LiveOptions& options_;
  const Time measured_from_, measured_until_;
  const Duration frame_interval_;
  std::vector<Session> sessions_;
  LiveMeasurement measurement_;
};

}  // namespace duet::contrib::load

#endif  // DUET_CONTRIB_LOAD_LIVE_RECORDER_H_

#include "contrib/load/live_recorder.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace duet::contrib::load {
namespace {

constexpr Duration kLate = std::chrono::milliseconds(10);  // of the generator

}  // namespace

bool KeptUp(const LiveMeasurement& measurement) {
  return measurement.late_sent.Percentile(99) <= kLate.count();
}

LiveRecorder::LiveRecorder(const LiveOptions& options, Time measured_from)
    : options_(options),
      measured_from_(measured_from),
      measured_until_(measured_from + options.measured),
      frame_interval_(Seconds(1 / options.frame_rate_hz)),
      sessions_(static_cast<std::size_t>(options.sessions)) {
  measurement_.sessions = options.sessions;
  measurement_.frame_rate_hz = options.frame_rate_hz;
  measurement_.interval_length = options.interval;
}

LiveInterval& LiveRecorder::IntervalOf(Time due) {
  const auto index =
      static_cast<std::size_t>((due - measured_from_) / measurement_.interval_length);
  if (index >= measurement_.timeline.size()) measurement_.timeline.resize(index + 1);
  return measurement_.timeline[index];
}

void LiveRecorder::Opened(int session, Time time) {
  sessions_[static_cast<std::size_t>(session)].opened = time;
}

void LiveRecorder::Sent(int session, const LiveSchedule::Frame& frame, Time now) {
  Session& to = sessions_[static_cast<std::size_t>(session)];
  if (to.ended) return;
  to.due.resize(static_cast<std::size_t>(frame.index) + 1);
  if (frame.lost) return;
  to.due.back() = frame.due;
  if (!IsMeasured(frame.due)) return;
  ++measurement_.sent;
  ++IntervalOf(frame.due).sent;
  measurement_.late_sent.Add((now - frame.due).count());
}

void LiveRecorder::Receive(int session, int frame, Time time) {
  const Session& from = sessions_[static_cast<std::size_t>(session)];
  const std::size_t index = static_cast<std::size_t>(frame);
  if (index >= from.due.size() || !from.due[index].has_value()) return;
  const Time due = *from.due[index];
  if (!IsMeasured(due)) return;
  const Duration latency = time - due;
  ++measurement_.answered;
  LiveInterval& interval = IntervalOf(due);
  measurement_.latency.Add(latency.count());
  interval.latency.Add(latency.count());
  if (latency > frame_interval_) {
    ++measurement_.late;
    ++interval.late;
  }
  if (latency > kMissedAfter) {
    ++measurement_.missed;
    ++interval.missed;
  }
}

void LiveRecorder::Arrived(const LiveEvent& event) {
  Session& session = sessions_[static_cast<std::size_t>(event.session)];
  if (event.ended) return End(&session, *event.ended);
  if (session.received == 0 && event.frames > 0) {
    measurement_.first_frame.Add((event.time - session.opened).count());
  }
  if (event.time >= measured_from_ && event.time < measured_until_) {
    measurement_.at_server.Add(Seconds(event.server_seconds).count());
  }
  for (int frame = event.first_frame; frame < event.first_frame + event.frames; ++frame) {
    if (frame < session.received) {
      ++measurement_.doubled;
      continue;
    }
    measurement_.lost += frame - session.received;
    session.received = frame + 1;
    Receive(event.session, frame, event.time);
  }
}

void LiveRecorder::End(Session* session, const EndedSession& ended) {
  session->ended = true;
  ++measurement_.ended[ended.code];
  measurement_.skipped += ended.skipped_frames;
  measurement_.interpolated += ended.gap_frames;
  measurement_.dropped += ended.late_frames;
  const bool failed = ended.code != absl::StatusCode::kOk;
  if (failed && session->received == 0) ++measurement_.refused;
  // Frames that never came; of a failed session they are missed, not lost.
  for (std::size_t frame = static_cast<std::size_t>(session->received); frame < session->due.size();
       ++frame) {
    if (!session->due[frame].has_value()) continue;
    if (!failed) ++measurement_.lost;
    if (!IsMeasured(*session->due[frame])) continue;
    ++measurement_.missed;
    ++IntervalOf(*session->due[frame]).missed;
  }
}

LiveMeasurement LiveRecorder::Finish(double seconds) {
  measurement_.seconds = seconds;
  return std::move(measurement_);
}

}  // namespace duet::contrib::load

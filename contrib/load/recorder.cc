#include "contrib/load/recorder.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace duet::contrib::load {
namespace {

void Add(Duration first_chunk, Duration whole_call, int frames, Answered* answered) {
  answered->first_chunk.Add(first_chunk.count());
  answered->whole_call.Add(whole_call.count());
  const double seconds = std::max(ToSeconds(whole_call), 1e-9);
  answered->frame_rate.Add(static_cast<int64_t>(1000.0 * frames / seconds));
}

}  // namespace

Recorder::Recorder(const Step& step, const LoadOptions& options, Time measured_from)
    : on_record_(options.on_record),
      measured_from_(measured_from),
      answered_until_(options.calls > 0 ? Time::max() : measured_from + options.measured) {
  measurement_.step = step;
  measurement_.by_kind.resize(options.kind_weights.size());
  measurement_.interval_length = options.interval;
}

Interval& Recorder::IntervalOf(Time due) {
  const auto index =
      static_cast<std::size_t>((due - measured_from_) / measurement_.interval_length);
  if (index >= measurement_.timeline.size()) measurement_.timeline.resize(index + 1);
  return measurement_.timeline[index];
}

void Recorder::Due(Time due) {
  if (due < measured_from_) return;
  ++measurement_.due;
  ++IntervalOf(due).due;
}

void Recorder::Ended(Time due, Time sent, std::size_t kind, const EndedCall& ended) {
  const Duration elapsed = ended.end - due;
  std::optional<Duration> first_chunk;
  if (ended.first_chunk.has_value()) first_chunk = *ended.first_chunk - due;
  if (on_record_) {
    on_record_(
        {due - measured_from_, sent - due, elapsed, first_chunk, kind, ended.code, ended.frames});
  }
  const bool answered = ended.code == absl::StatusCode::kOk;
  if (answered && ended.end >= measured_from_ && ended.end < answered_until_) {
    ++measurement_.answered_in_time;
    measurement_.frames_in_time += ended.frames;
  }
  if (due < measured_from_) return;
  ++measurement_.sent;
  measurement_.late.Add((sent - due).count());
  measurement_.ended[ended.code].Add(elapsed.count());
  Interval& interval = IntervalOf(due);
  if (!answered) {
    ++interval.failed;
    return;
  }
  ++interval.answered;
  interval.whole_call.Add(elapsed.count());
  for (Answered* answered_calls : {&measurement_.all, &measurement_.by_kind[kind]}) {
    Add(first_chunk.value_or(elapsed), elapsed, ended.frames, answered_calls);
  }
}

Measurement Recorder::Finish(double seconds) {
  measurement_.seconds = seconds;
  return std::move(measurement_);
}

}  // namespace duet::contrib::load

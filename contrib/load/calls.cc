#include "contrib/load/calls.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <unordered_map>
#include <utility>

#include "model/base/random.h"

namespace duet::contrib::load {
namespace {

constexpr Duration kLongestWait = std::chrono::milliseconds(200);  // between checks of `stopped`

double PerSecond(int64_t count, double seconds) {
  return seconds > 0 ? static_cast<double>(count) / seconds : 0;
}

class Generator {
 public:
  Generator(const CallLoad& load, const CallOptions& options, CallTarget& target)
      : options_(options),
        target_(target),
        begin_(target.Now()),
        measured_from_(begin_ + options.warm_up),
        measured_until_(measured_from_ + options.measured) {
    figures_.load = load;
    if (IsOpenLoop()) {
      NextArrival();
    } else {
      idle_callers_.assign(static_cast<std::size_t>(load.callers), begin_);
    }
  }

  CallFigures Run() {
    while (!IsOver() || !calls_.empty()) {
      SendWhatIsDue();
      if (IsOver() && calls_.empty()) break;
      for (const EndedCall& ended : target_.Wait(NextEvent())) Take(ended);
    }
    figures_.seconds = ToSeconds(measured_until_ - measured_from_);
    return std::move(figures_);
  }

 private:
  struct OpenCall {
    Time due, sent;
  };

  bool IsOpenLoop() const { return figures_.load.rate_hz > 0; }

  // Gaps from an exponential distribution, as of independent callers.
  void NextArrival() {
    arrival_seconds_ -= std::log(random_.OpenUniform()) / figures_.load.rate_hz;
    next_due_ = begin_ + Seconds(arrival_seconds_);
  }

  // Whether no further call is due. The end of the measured time is then fixed.
  bool IsOver() {
    if (is_over_) return true;
    const Time now = target_.Now();
    const bool stopped = options_.stopped && options_.stopped();
    if (!stopped && now < measured_until_) return false;
    measured_until_ = std::max(measured_from_, std::min(now, measured_until_));
    // Calls that were due before the end and were never sent.
    for (; IsOpenLoop() && next_due_ < measured_until_; NextArrival()) CountDue(next_due_);
    return is_over_ = true;
  }

  void CountDue(Time due) { figures_.due += due >= measured_from_ ? 1 : 0; }

  void SendWhatIsDue() {
    const Time now = target_.Now();
    while (IsOpenLoop() && !IsOver() && next_due_ <= now &&
           static_cast<int>(calls_.size()) < options_.max_in_flight) {
      Send(next_due_);
      NextArrival();
    }
    while (!IsOver() && !idle_callers_.empty()) {
      const Time due = idle_callers_.back();
      idle_callers_.pop_back();
      Send(due);
    }
  }

  void Send(Time due) {
    CountDue(due);
    calls_.emplace(next_id_, OpenCall{due, target_.Now()});
    target_.Start(next_id_++);
  }

  Time NextEvent() {
    Time next = target_.Now() + kLongestWait;
    if (IsOver()) return next;
    next = std::min(next, measured_until_);
    const bool has_place = static_cast<int>(calls_.size()) < options_.max_in_flight;
    return IsOpenLoop() && has_place ? std::min(next, next_due_) : next;
  }

  void Take(const EndedCall& ended) {
    const auto found = calls_.find(ended.id);
    const OpenCall call = found->second;
    calls_.erase(found);
    if (!IsOpenLoop()) idle_callers_.push_back(ended.end);
    Record(call, ended);
  }

  void Record(const OpenCall& call, const EndedCall& ended) {
    const bool answered = ended.code == absl::StatusCode::kOk;
    if (answered && ended.end >= measured_from_ && ended.end < measured_until_) {
      ++figures_.answered_in_time;
      figures_.frames_in_time += ended.frames;
    }
    if (call.due < measured_from_) return;
    ++figures_.sent;
    figures_.late.Add(call.sent - call.due);
    figures_.ended[ended.code].Add(ended.end - call.due);
    if (!answered) return;
    figures_.whole_call.Add(ended.end - call.due);
    figures_.first_chunk.Add(ended.first_chunk.value_or(ended.end) - call.due);
  }

  const CallOptions& options_;
  CallTarget& target_;
  const Time begin_, measured_from_;
  Time measured_until_;
  CallFigures figures_;
  base::Random random_{0};
  std::unordered_map<int64_t, OpenCall> calls_;
  int64_t next_id_ = 0;
  double arrival_seconds_ = 0;
  Time next_due_;                   // of an open loop
  std::vector<Time> idle_callers_;  // of a closed loop: since when each has been idle
  bool is_over_ = false;
};

}  // namespace

double CallFigures::answered_per_second() const { return PerSecond(answered_in_time, seconds); }
double CallFigures::frames_per_second() const { return PerSecond(frames_in_time, seconds); }

CallFigures RunCalls(const CallLoad& load, const CallOptions& options, CallTarget& target) {
  return Generator(load, options, target).Run();
}

}  // namespace duet::contrib::load

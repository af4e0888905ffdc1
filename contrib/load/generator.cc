#include "contrib/load/generator.h"

#include <algorithm>
#include <optional>
#include <unordered_map>
#include <vector>

#include "contrib/load/arrivals.h"
#include "contrib/load/recorder.h"
#include "model/base/random.h"

namespace duet::contrib::load {
namespace {

constexpr Duration kLongestWait = std::chrono::milliseconds(200);     // between checks of `stopped`
constexpr Duration kBackgroundPause = std::chrono::milliseconds(50);  // after a rejection
constexpr int kKinds = 1, kArrivals = 2;                              // streams of random numbers

// The state of a call in flight.
struct OpenCall {
  Time due;
  Time sent;
  std::size_t kind = 0;
  bool is_background = false;
};

class Generator {
 public:
  Generator(const Step& step, const LoadOptions& options, Target& target)
      : step_(step),
        options_(options),
        target_(target),
        kinds_(options.kind_weights),
        random_(options.seed, kKinds),
        arrivals_(options.arrivals, std::max(step.rate_hz, 1e-9),
                  base::Random(options.seed, kArrivals).Below(int64_t{1} << 53)),
        begin_(target.Now()),
        measured_from_(begin_ + options.warm_up),
        recorder_(step, options, measured_from_) {
    if (IsOpenLoop()) {
      next_due_ = begin_ + arrivals_.Next();
    } else {
      idle_callers_.assign(static_cast<std::size_t>(step.callers), begin_);
    }
  }

  Measurement Run() {
    while (!IsOver() || in_flight_ > 0) {
      SendWhatIsDue();
      if (IsOver() && in_flight_ == 0) break;
      for (const EndedCall& ended : target_.Wait(NextEvent())) Take(ended);
    }
    EndBackground();
    const Time end = measured_until_.value_or(target_.Now());
    return recorder_.Finish(ToSeconds(end - measured_from_));
  }

 private:
  bool IsOpenLoop() const { return step_.rate_hz > 0; }
  bool HasSentEnough() const {
    return options_.calls > 0 && recorder_.measured_due() >= options_.calls;
  }

  // Whether no further call is due. The end of the measured time is then fixed, unless a number of
  // calls was requested: then the last of them ends it.
  bool IsOver() {
    if (is_over_) return true;
    const Time now = target_.Now();
    const bool stopped = options_.stopped && options_.stopped();
    if (!stopped && options_.calls > 0) return is_over_ = HasSentEnough();
    const Time end = options_.calls > 0 ? now : measured_from_ + options_.measured;
    if (!stopped && now < end) return false;
    measured_until_ = std::max(measured_from_, std::min(now, end));
    recorder_.CloseAt(*measured_until_);
    SkipDueUntil(*measured_until_);
    return is_over_ = true;
  }

  // Calls that were due before the end and were never sent.
  void SkipDueUntil(Time end) {
    for (; IsOpenLoop() && next_due_ < end; next_due_ = begin_ + arrivals_.Next()) {
      recorder_.Due(next_due_);
    }
  }

  void SendWhatIsDue() {
    const Time now = target_.Now();
    if (IsOpenLoop()) {
      while (!IsOver() && next_due_ <= now && in_flight_ < options_.max_in_flight) {
        Send(next_due_);
        next_due_ = begin_ + arrivals_.Next();
      }
    } else {
      while (!IsOver() && !idle_callers_.empty()) {
        const Time due = idle_callers_.back();
        idle_callers_.pop_back();
        Send(due);
      }
    }
    while (!IsOver() && background_ < options_.background_callers && background_due_ <= now) {
      ++background_;
      Start({now, now, options_.background_kind, true});
    }
  }

  void Send(Time due) {
    recorder_.Due(due);
    ++in_flight_;
    Start({due, target_.Now(), kinds_.Pick(random_.Uniform()), false});
  }

  void Start(const OpenCall& call) {
    calls_.emplace(next_id_, call);
    target_.Start(next_id_++, call.kind);
  }

  Time NextEvent() {
    Time next = target_.Now() + kLongestWait;
    if (IsOver()) return next;
    if (options_.calls == 0) next = std::min(next, measured_from_ + options_.measured);
    if (IsOpenLoop() && in_flight_ < options_.max_in_flight) next = std::min(next, next_due_);
    if (background_ < options_.background_callers) next = std::min(next, background_due_);
    return next;
  }

  void Take(const EndedCall& ended) {
    const auto found = calls_.find(ended.id);
    const OpenCall call = found->second;
    calls_.erase(found);
    if (call.is_background) {
      --background_;
      if (ended.code != absl::StatusCode::kOk) background_due_ = ended.end + kBackgroundPause;
      recorder_.BackgroundEnded(ended.code);
      return;
    }
    --in_flight_;
    if (!IsOpenLoop()) idle_callers_.push_back(ended.end);
    recorder_.Ended(call.due, call.sent, call.kind, ended);
    if (options_.calls > 0) last_end_ = std::max(last_end_, ended.end);
    if (is_over_ && !measured_until_ && in_flight_ == 0) measured_until_ = last_end_;
  }

  // Ends the background after all measured calls, which it would disturb.
  void EndBackground() {
    target_.CancelAll();
    while (!calls_.empty()) {
      for (const EndedCall& ended : target_.Wait(target_.Now() + kLongestWait)) {
        calls_.erase(ended.id);
      }
    }
  }

  const Step step_;
  const LoadOptions& options_;
  Target& target_;
  const WeightedChoice kinds_;
  base::Random random_;
  Arrivals arrivals_;
  const Time begin_;
  const Time measured_from_;
  Recorder recorder_;
  std::unordered_map<int64_t, OpenCall> calls_;
  int64_t next_id_ = 0;
  int in_flight_ = 0;  // without the background
  int background_ = 0;
  Time next_due_;                   // of an open loop
  std::vector<Time> idle_callers_;  // of a closed loop: since when each has been idle
  Time background_due_;
  bool is_over_ = false;
  std::optional<Time> measured_until_;
  Time last_end_;
};

}  // namespace

Measurement RunStep(const Step& step, const LoadOptions& options, Target& target) {
  return Generator(step, options, target).Run();
}

}  // namespace duet::contrib::load

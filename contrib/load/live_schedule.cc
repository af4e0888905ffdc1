#include "contrib/load/live_schedule.h"

#include <algorithm>
#include <cmath>

namespace duet::contrib::load {
namespace {

constexpr double kOpeningSeconds = 1;

}  // namespace

LiveSchedule::LiveSchedule(const LiveOptions& options, int session, Time begin)
    : options_(options), random_(options.seed, session) {
  // Whole frames later than the session before, so that the opening does not decide the phase.
  const double share = static_cast<double>(session) / options.sessions;
  const double frames = std::floor(share * kOpeningSeconds * options.frame_rate_hz);
  const double phase = options.in_step ? 0 : share;
  opens_ = begin + Seconds((frames + phase) / options.frame_rate_hz);
  const Duration room = std::max(Duration{0}, options.measured - options.conditions.stall);
  stalls_from_ = begin + options.warm_up + Seconds(random_.Uniform() * ToSeconds(room));
  stalls_until_ = stalls_from_ + options.conditions.stall;
  last_due_ = opens_;
}

Time LiveSchedule::DueOf(int frame) const {
  return opens_ + Seconds(frame / options_.frame_rate_hz);
}

LiveSchedule::Frame LiveSchedule::Next() {
  Frame frame;
  frame.index = next_++;
  frame.due =
      DueOf(frame.index) + Seconds(random_.Uniform() * ToSeconds(options_.conditions.jitter));
  if (frame.due >= stalls_from_ && frame.due < stalls_until_) frame.due = stalls_until_;
  frame.due = last_due_ = std::max(last_due_, frame.due);
  frame.lost = random_.Chance(options_.conditions.loss) && frame.index > 0;
  return frame;
}

}  // namespace duet::contrib::load

#include "model/cleanup/lasting.h"

#include <cstddef>

#include "model/cleanup/turns.h"

namespace duet::cleanup {

std::vector<float> SharesOfLasting(const std::function<bool(int)>& lasts, const Lasting& lasting,
                                   const Timing& timing, int frames) {
  std::vector<float> shares(static_cast<std::size_t>(frames));
  bool any = false;
  double since = lasting.before_seconds;
  for (int t = 0; t < frames; ++t) {
    since = lasts(t) ? since + 1 / timing.frame_rate_hz : 0;
    if (t < timing.settled || since <= lasting.longest_seconds) continue;
    shares[static_cast<std::size_t>(t)] =
        SmoothStep((since - lasting.longest_seconds) / lasting.ease_seconds);
    any = true;
  }
  if (!any) return {};
  LimitSlopes(timing.settled, static_cast<float>(1 / timing.Frames(lasting.ease_seconds)), &shares);
  return shares;
}

}  // namespace duet::cleanup

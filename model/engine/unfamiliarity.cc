#include "model/engine/unfamiliarity.h"

#include <cmath>
#include <utility>
#include <vector>

#include "model/engine/leader_statistics.h"
#include "model/engine/window_plan.h"
#include "model/motion/resample.h"

namespace duet::engine {
namespace {

// Windows that are measured need share no more than the frame they meet in.
constexpr int kOverlap = 1;

motion::Poses LeaderWindow(const ModelDescription& model, const ClipRequest& request, int start,
                           int length) {
  motion::Poses window(length, model.skeleton.joint_count());
  for (int t = 0; t < length; ++t) {
    SampleLinear(request.leader, (start + t) * request.frame_rate_hz / model.frame_rate_hz,
                 window[t]);
  }
  return window;
}

}  // namespace

std::optional<double> Unfamiliarity(const ModelDescription& model, const ClipRequest& request) {
  if (!model.leader_statistics) return std::nullopt;
  const int frames = motion::ResampledFrameCount(request.leader.frame_count(),
                                                 request.frame_rate_hz, model.frame_rate_hz);
  const WindowPlan plan = PlanWindows(frames, model.window_frames, kOverlap);
  std::vector<double> windows;
  for (const int start : plan.starts) {
    windows.push_back(Unfamiliarity(*model.leader_statistics, model.skeleton,
                                    LeaderWindow(model, request, start, plan.length),
                                    model.frame_rate_hz));
    // Positions may be as large as a float can be.
    if (!std::isfinite(windows.back())) return std::nullopt;
  }
  return NinthDecile(std::move(windows));
}

}  // namespace duet::engine

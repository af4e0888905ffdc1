#include "model/engine/live_timing.h"

#include <algorithm>
#include <cmath>

#include "model/engine/windows.h"

namespace duet::engine {
namespace {

// So that a frame that coincides with a model frame is not missed because of rounding.
constexpr double kEpsilon = 1e-6;
// Evaluations a second are no more than this, whatever the model's rate.
constexpr double kMostEvaluationsHz = 15;
// How much of what was sent each plan makes anew, to continue from there. The frames right after
// settled ones hardly leave them, and clean-up eases in over this time: a motion of such frames
// alone would drift. With a delay it is longer by the delay, because plans may change more where
// more of the leader is known.
constexpr double kRemadeSeconds = 0.4;
// How far a plan reaches beyond the last frame that was sent, at least: for frames that the server
// may have to skip, and provisional frames. The more frames of a leader who comes to rest a plan
// has, the less its follower moves (docs/decisions/live.md). A model with a
// lookahead plans at least as far: its windows end with an unknown future in clips, too.
constexpr double kFutureSeconds = 0.4;
// The neighbours of a spline at the end of a plan.
constexpr int kMarginFrames = 2;
// The neighbours of splines, and rounding, at either end of the history.
constexpr int kHistoryMarginFrames = 8;

}  // namespace

LiveTiming::LiveTiming(const ModelDescription& model, double frame_rate_hz, int delay_frames)
    : delay_frames_(delay_frames),
      model_frames_per_frame_(model.frame_rate_hz / frame_rate_hz),
      model_frames_between_(
          std::max(1, static_cast<int>(std::lround(model.frame_rate_hz / kMostEvaluationsHz)))) {
  const double delay = std::ceil(delay_frames * model_frames_per_frame_);
  const double wanted = std::ceil(kFutureSeconds * model.frame_rate_hz - kEpsilon);
  // At least the frames that are due until the next evaluation.
  const double due = delay + model_frames_between_ + std::ceil(model_frames_per_frame_);
  future_ = std::max(
      {static_cast<int>(wanted), model.lookahead_frames, static_cast<int>(due) + kMarginFrames});
  past_ = SettledOverlap(model.window_frames);
  const int remade = static_cast<int>(std::lround(kRemadeSeconds * model.frame_rate_hz));
  const int room = model.window_frames - past_ - future_ - remade;
  remade_ = remade + std::clamp(static_cast<int>(delay), 0, std::max(0, room));
}

int LiveTiming::ModelFrameAt(int frame) const {
  return static_cast<int>(std::floor(ToModelFrame(frame) + kEpsilon));
}

int LiveTiming::history_frames() const {
  const double between = model_frames_between_ / model_frames_per_frame_;
  return static_cast<int>(std::ceil((past_ + remade_) / model_frames_per_frame_ + between)) +
         delay_frames_ + kHistoryMarginFrames;
}

bool LiveTiming::IsEvaluation(int frame) const {
  const int answered = frame - delay_frames_;
  if (answered <= 1) return answered >= 0;
  // When the frame before has completed a model frame, the plan continues exactly from there.
  return ModelFrameAt(answered - 1) / model_frames_between_ !=
         ModelFrameAt(answered - 2) / model_frames_between_;
}

int LiveTiming::EvaluationAfter(int frame) const {
  int next = std::max(frame + 1, delay_frames_);
  while (!IsEvaluation(next)) ++next;
  return next;
}

int LiveTiming::EvaluationNotAfter(int frame) const {
  int last = frame;
  while (!IsEvaluation(last)) --last;
  return last;
}

}  // namespace duet::engine

#include "model/engine/window_state.h"

#include <algorithm>

#include "absl/types/span.h"
#include "model/engine/window_plan.h"

namespace duet::engine {

void WindowState::Add(int start, const motion::Poses& window, const CrossFade& cross_fade) {
  const int first = start - begin_;
  const int shared = follower_.frame_count() - first;
  cross_fade.Blend(window, first, &follower_);
  follower_.Append(window.frames(shared, window.frame_count() - shared));
  ++window_count_;
}

void WindowState::DropFrom(int frame) {
  follower_.Resize(std::clamp(frame - begin_, 0, follower_.frame_count()));
}

void WindowState::DropBefore(int frame) {
  const int begin = std::clamp(frame, begin_, end());
  follower_.DropFront(begin - begin_);
  begin_ = begin;
}

bool ContinuesFromSettledFrames(const ModelDescription& model) {
  return model.samples && model.accepts_follower_start;
}

int WindowOverlap(const ModelDescription& model) {
  return ContinuesFromSettledFrames(model)
             ? SettledOverlap(model.window_frames) + model.lookahead_frames
             : CrossFadeOverlap(model.window_frames);
}

void ContinueFrom(const WindowState& state, int frame, const ModelDescription& model,
                  SynthesisWindow* window) {
  if (!model.accepts_follower_start) return;
  const motion::Poses& follower = state.follower();
  const int first = frame - state.begin();
  const absl::Span<const motion::Vec3> pose = follower[first];
  window->start =
      FollowerStart{follower.at(first, model.skeleton.root), {pose.begin(), pose.end()}};
  if (!ContinuesFromSettledFrames(model)) return;
  window->settled = motion::Poses(0, follower.joint_count());
  window->settled.Append(follower.frames(first, follower.frame_count() - first));
}

}  // namespace duet::engine

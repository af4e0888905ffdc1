#ifndef DUET_MODEL_ENGINE_WINDOW_STATE_H_
#define DUET_MODEL_ENGINE_WINDOW_STATE_H_

#include "model/engine/cross_fade.h"
#include "model/engine/model_description.h"
#include "model/engine/synthesizer.h"
#include "model/motion/poses.h"

namespace duet::engine {

// What a synthesis in overlapping windows carries from one window to the next: the number of
// windows so far, and the follower's frames that later windows may still change or continue from.
// Frames are counted at the model's rate from the first frame of the first window.
//
// A value: copies are independent, so a synthesis can try a window on a copy and discard it.
//
//   WindowState state(model.skeleton.joint_count());
//   for each window, at model frame `start`:
//     if (state.window_count() > 0) ContinueFrom(state, start, model, &window);
//     ... evaluate the window ...
//     state.Add(start, follower, cross_fade);
//     ... use state.follower(), then state.DropBefore(next start) ...
//
// Cost:    memory of the frames that are kept.
// Threads: not safe to call concurrently.
class WindowState {
 public:
  explicit WindowState(int joints) : follower_(0, joints) {}

  int window_count() const { return window_count_; }

  // The frames that are kept: [begin(), end()). Frame `begin()` is follower()[0].
  int begin() const { return begin_; }
  int end() const { return begin_ + follower_.frame_count(); }
  const motion::Poses& follower() const { return follower_; }

  // Adds the follower of a window that begins at frame `start`, in [begin(), end()]. The frames
  // that it shares with follower() are cross-faded. Requires `window` to reach end() or beyond.
  void Add(int start, const motion::Poses& window, const CrossFade& cross_fade);

  // Drops the frames from `frame` on, so that the next window answers them again.
  void DropFrom(int frame);

  // Drops the frames before `frame`. Does nothing if they were dropped already.
  void DropBefore(int frame);

 private:
  int window_count_ = 0;
  int begin_ = 0;
  motion::Poses follower_;  // blended
};

// True if each window of the model continues from frames that the window before it settled, rather
// than from their first pose only. Another sample would be another motion.
bool ContinuesFromSettledFrames(const ModelDescription& model);

// Number of frames that neighbouring windows of the model share.
int WindowOverlap(const ModelDescription& model);

// Sets the fields of `window`, which begins at frame `frame`, that continue the follower so far, as
// far as the model uses them: `start` and `settled`. Requires `frame` in [begin(), end()).
void ContinueFrom(const WindowState& state, int frame, const ModelDescription& model,
                  SynthesisWindow* window);

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_WINDOW_STATE_H_

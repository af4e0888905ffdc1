#ifndef DUET_MODEL_ENGINE_LIVE_TIMING_H_
#define DUET_MODEL_ENGINE_LIVE_TIMING_H_

#include "model/engine/model_description.h"

namespace duet::engine {

// When a live session evaluates the network, and what an evaluation reads. A pure function of the
// model, the caller's frame rate and the delay, so that a resumed session evaluates at the same
// frames.
class LiveTiming {
 public:
  // Requires a positive rate.
  LiveTiming(const ModelDescription& model, double frame_rate_hz, int delay_frames);

  double ToModelFrame(int frame) const { return frame * model_frames_per_frame_; }
  double ToCallerFrame(int model_frame) const { return model_frame / model_frames_per_frame_; }
  // The last model frame that is not after a frame of the caller.
  int ModelFrameAt(int frame) const;

  int delay_frames() const { return delay_frames_; }
  // Model frames in one window: of the follower's past that it continues from, of what was sent and
  // is made anew, and of the future.
  int past_frames() const { return past_; }
  int remade_frames() const { return remade_; }
  int future_frames() const { return future_; }
  // Number of the caller's last frames that an evaluation may read, of both motions.
  int history_frames() const;

  // Whether the network is evaluated when leader frame `frame` has arrived. The first frame that
  // has an answer (delay_frames) is such a frame.
  bool IsEvaluation(int frame) const;
  // The first evaluation after, and the last one not after, a leader frame. Requires the latter to
  // be at least delay_frames.
  int EvaluationAfter(int frame) const;
  int EvaluationNotAfter(int frame) const;

 private:
  int delay_frames_;
  double model_frames_per_frame_;  // model rate / caller's rate
  int model_frames_between_;       // evaluations
  int past_, remade_, future_;
};

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_LIVE_TIMING_H_

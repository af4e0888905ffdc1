#ifndef DUET_MODEL_ENGINE_LIVE_CLIP_H_
#define DUET_MODEL_ENGINE_LIVE_CLIP_H_

#include <vector>

#include "model/engine/clip_synthesis.h"
#include "model/engine/label_track.h"
#include "model/engine/live_synthesis.h"
#include "model/engine/model_description.h"
#include "model/engine/synthesizer.h"
#include "model/motion/poses.h"

namespace duet::engine {

// A clip whose leader arrives frame by frame, as in a live session. Has the methods of
// ClipSynthesis, so that both run in the same loop.
class LiveClip {
 public:
  // Requires AnswersLive(model).
  LiveClip(const ModelDescription& model, ClipRequest request, int delay_frames);

  bool HasNextWindow() const { return live_.NeedsWindow(); }
  SynthesisWindow NextWindow() { return live_.NextWindow(); }
  // Returns the frames that became final until the next window.
  motion::Poses Accept(const motion::Poses& follower);

 private:
  std::vector<float> WeightsAt(int frame);
  // Adds the next leader frame, with a change of the labels if they change there.
  void AddFrame();
  // Adds leader frames until a window is needed, and takes what becomes final.
  void Advance(motion::Poses* final_frames);

  motion::Poses leader_;
  int next_frame_ = 0;  // of the leader
  LabelTrack labels_;
  std::vector<float> weights_;  // of the last frame
  LiveSynthesis live_;
};

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_LIVE_CLIP_H_

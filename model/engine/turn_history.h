#ifndef DUET_MODEL_ENGINE_TURN_HISTORY_H_
#define DUET_MODEL_ENGINE_TURN_HISTORY_H_

#include <vector>

#include "model/engine/label_track.h"
#include "model/engine/model_description.h"
#include "model/engine/synthesizer.h"
#include "model/motion/poses.h"

namespace duet::engine {

// Follows the turns of a clip's follower from window to window, so that each window knows what is
// left of a turn that began before it (SynthesisWindow::turns_around). Does nothing for models
// without turning classes or hips.
//
// Frames are those of the model's rate. Cost: memory of a number per frame of the clip.
// Threads: not safe to call concurrently.
class TurnHistory {
 public:
  // `labels` has keyframes at `label_rate_hz`.
  TurnHistory(const ModelDescription& model, const LabelTrack& labels, double label_rate_hz,
              int frames);

  // Whether it needs the frames of the follower.
  bool is_used() const { return !asks_.empty(); }

  // Adds the frames of the clip from the last one that was added (frame 0 at first) up to the first
  // one of the next window. Shapes: both alike.
  void Add(const motion::Skeleton& skeleton, const motion::Poses& leader,
           const motion::Poses& follower);
  // The number of frames that were added.
  int end() const { return static_cast<int>(turned_.size()); }

  // For a window of the frames [begin, end). Requires begin < this->end() unless it is 0.
  TurnsAround Around(int begin, int end) const;

 private:
  std::vector<bool> asks_;      // whether a label asks for a turn, of every frame
  std::vector<double> turned_;  // degrees, of every frame that was added
};

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_TURN_HISTORY_H_

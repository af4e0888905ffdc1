#ifndef DUET_MODEL_ENGINE_LABEL_TRACK_H_
#define DUET_MODEL_ENGINE_LABEL_TRACK_H_

#include <vector>

namespace duet::engine {

// The label vector at one frame of the leader, at the leader's own rate.
struct LabelKeyframe {
  int frame = 0;
  std::vector<float> weights;  // [classes]
};

// A label vector over time: linear between keyframes, constant before the first and after the last.
class LabelTrack {
 public:
  // One label vector for the whole clip.
  explicit LabelTrack(std::vector<float> weights);
  // Keyframes in strictly increasing frame order, at least one.
  explicit LabelTrack(std::vector<LabelKeyframe> keyframes);

  // Changes the weights linearly from those at `frame`, at least 0, to `weights` within
  // `ease_frames` frames; with 0, they apply from `frame` on. Keyframes after `frame` are dropped.
  void Change(int frame, int ease_frames, std::vector<float> weights);
  // Drops keyframes that have no effect from `frame` on.
  void DropBefore(int frame);

  // Writes the weights at a fractional frame. Shapes: out [classes].
  void At(double frame, float* out) const;

 private:
  std::vector<LabelKeyframe> keyframes_;
};

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_LABEL_TRACK_H_

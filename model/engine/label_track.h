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

  // Writes the weights at a fractional frame. Shapes: out [classes].
  void At(double frame, float* out) const;

 private:
  std::vector<LabelKeyframe> keyframes_;
};

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_LABEL_TRACK_H_

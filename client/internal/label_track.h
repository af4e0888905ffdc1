#ifndef DUET_CLIENT_INTERNAL_LABEL_TRACK_H_
#define DUET_CLIENT_INTERNAL_LABEL_TRACK_H_

#include <utility>
#include <vector>

#include "client/request.h"

namespace duet::client::internal {

// The weights of a session over its frames: linear between keyframes, constant before the first and
// after the last. A class without a weight has weight 0.
class LabelTrack {
 public:
  // `keyframes`: by increasing frame.
  explicit LabelTrack(std::vector<WeightKeyframe> keyframes) : keyframes_(std::move(keyframes)) {}

  // Changes the weights linearly from those at `frame` to `weights` within `ease_frames` frames.
  // All later keyframes are dropped.
  void Change(int frame, const std::vector<ClassWeight>& weights, int ease_frames);

  // The keyframes that determine the weights from `frame` on.
  std::vector<WeightKeyframe> From(int frame) const;

 private:
  std::vector<ClassWeight> At(int frame) const;
  void Append(int frame, std::vector<ClassWeight> weights);

  std::vector<WeightKeyframe> keyframes_;
};

}  // namespace duet::client::internal

#endif  // DUET_CLIENT_INTERNAL_LABEL_TRACK_H_

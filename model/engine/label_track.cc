#include "model/engine/label_track.h"

#include <algorithm>
#include <utility>

namespace duet::engine {

LabelTrack::LabelTrack(std::vector<float> weights) {
  keyframes_.push_back({0, std::move(weights)});
}

LabelTrack::LabelTrack(std::vector<LabelKeyframe> keyframes) : keyframes_(std::move(keyframes)) {}

void LabelTrack::Change(int frame, int ease_frames, std::vector<float> weights) {
  // The last frame with the old weights.
  const int last = ease_frames > 0 ? frame : frame - 1;
  std::vector<float> old(weights.size());
  At(last, old.data());
  while (!keyframes_.empty() && keyframes_.back().frame >= last) keyframes_.pop_back();
  if (last >= 0) keyframes_.push_back({last, std::move(old)});
  keyframes_.push_back({frame + ease_frames, std::move(weights)});
}

void LabelTrack::DropBefore(int frame) {
  auto first = keyframes_.begin();
  while (first + 1 != keyframes_.end() && (first + 1)->frame <= frame) ++first;
  keyframes_.erase(keyframes_.begin(), first);
}

void LabelTrack::At(double frame, float* out) const {
  const auto after = std::upper_bound(
      keyframes_.begin(), keyframes_.end(), frame,
      [](double at, const LabelKeyframe& keyframe) { return at < keyframe.frame; });
  const auto before = after == keyframes_.begin() ? after : after - 1;
  // Held before the first keyframe and after the last, where both are the same.
  const LabelKeyframe& a = *before;
  const LabelKeyframe& b = after == keyframes_.end() ? a : *after;
  const double span = b.frame - a.frame;
  const float t = span > 0 ? static_cast<float>((frame - a.frame) / span) : 0;
  for (std::size_t c = 0; c < a.weights.size(); ++c) {
    out[c] = a.weights[c] + (b.weights[c] - a.weights[c]) * t;
  }
}

}  // namespace duet::engine

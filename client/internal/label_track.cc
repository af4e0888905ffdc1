#include "client/internal/label_track.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <string>
#include <utility>

namespace duet::client::internal {
namespace {

// `share` of the way from `a` to `b`. Contains the classes of both.
std::vector<ClassWeight> Mix(const std::vector<ClassWeight>& a, const std::vector<ClassWeight>& b,
                             float share) {
  std::map<std::string, float> mixed;
  for (const ClassWeight& weight : a) {
    mixed[weight.interaction_class] += (1 - share) * weight.weight;
  }
  for (const ClassWeight& weight : b) mixed[weight.interaction_class] += share * weight.weight;
  std::vector<ClassWeight> weights;
  for (const auto& [name, weight] : mixed) weights.push_back({name, weight});
  return weights;
}

}  // namespace

std::vector<ClassWeight> LabelTrack::At(int frame) const {
  const auto after =
      std::find_if(keyframes_.begin(), keyframes_.end(),
                   [frame](const WeightKeyframe& keyframe) { return keyframe.frame > frame; });
  if (after == keyframes_.begin()) {
    return after == keyframes_.end() ? std::vector<ClassWeight>() : after->weights;
  }
  const WeightKeyframe& before = *(after - 1);
  if (after == keyframes_.end() || before.frame == frame) return before.weights;
  const float share =
      static_cast<float>(frame - before.frame) / static_cast<float>(after->frame - before.frame);
  return Mix(before.weights, after->weights, share);
}

void LabelTrack::Append(int frame, std::vector<ClassWeight> weights) {
  while (!keyframes_.empty() && keyframes_.back().frame >= frame) keyframes_.pop_back();
  keyframes_.push_back({frame, std::move(weights)});
}

void LabelTrack::Change(int frame, const std::vector<ClassWeight>& weights, int ease_frames) {
  if (ease_frames > 0) {
    Append(frame, At(frame));
    Append(frame + ease_frames, weights);
    return;
  }
  // A step needs the old weights one frame before it.
  if (frame > 0) Append(frame - 1, At(frame - 1));
  Append(frame, weights);
}

std::vector<WeightKeyframe> LabelTrack::From(int frame) const {
  std::size_t first = 0;
  while (first + 1 < keyframes_.size() && keyframes_[first + 1].frame <= frame) ++first;
  return {keyframes_.begin() + static_cast<std::ptrdiff_t>(first), keyframes_.end()};
}

}  // namespace duet::client::internal

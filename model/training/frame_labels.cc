#include "model/training/frame_labels.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace duet::training {
namespace {

// A frame within the clip stays within it; its ends stay ends.
int Shifted(int frame, int frames, double deviation, base::Random* random) {
  if (frame <= 0 || frame >= frames) return frame;
  return std::clamp(frame + static_cast<int>(std::lround(random->Normal(deviation))), 0, frames);
}

}  // namespace

std::vector<float> DrawFrameLabels(const dataset::Sequence& sequence, int classes,
                                   const FlowTraining::FrameLabels& options, base::Random* random) {
  const int frames = sequence.pair.leader.frame_count();
  std::vector<dataset::LabelSpan> spans = sequence.labels;
  if (spans.empty()) spans.push_back({sequence.interaction_class, 0, frames});
  std::vector<float> weights(static_cast<std::size_t>(frames) * static_cast<std::size_t>(classes));
  const auto at = [&](int frame, int c) -> float& {
    return weights[static_cast<std::size_t>(frame) * static_cast<std::size_t>(classes) +
                   static_cast<std::size_t>(c)];
  };
  for (const dataset::LabelSpan& span : spans) {
    const int begin = Shifted(span.begin, frames, options.shift, random);
    const int end = Shifted(span.end, frames, options.shift, random);
    for (int t = begin; t < end; ++t) at(t, span.interaction_class) = 1;
  }
  for (int c = 0; c < classes; ++c) {
    const bool unlabelled = random->Chance(options.unlabelled);
    const bool avoided = random->Chance(options.avoided);
    for (int t = 0; t < frames; ++t) {
      if (unlabelled) at(t, c) = 0;
      if (avoided && !unlabelled && at(t, c) == 0) at(t, c) = -1;
    }
  }
  return weights;
}

}  // namespace duet::training

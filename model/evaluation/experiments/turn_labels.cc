#include "model/evaluation/experiments/turn_labels.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "model/evaluation/experiments/synthesizer_method.h"

namespace duet::evaluation::experiments {
namespace {

constexpr double kStretchSeconds = 4;

}  // namespace

TurnStretches FindTurnStretches(const dataset::Sequence& take, int turn_class,
                                double frame_rate_hz) {
  const int frames = take.pair.leader.frame_count();
  const int length = static_cast<int>(std::lround(kStretchSeconds * frame_rate_hz));
  std::vector<bool> led(static_cast<size_t>(frames));
  for (const dataset::LabelSpan& span : take.labels) {
    if (span.interaction_class != turn_class) continue;
    for (int t = span.begin; t < span.end; ++t) led[static_cast<size_t>(t)] = true;
  }
  TurnStretches stretches;
  for (int begin = 0; begin < frames;) {
    int end = begin;
    while (end < frames && led[static_cast<size_t>(end)] == led[static_cast<size_t>(begin)]) ++end;
    if (led[static_cast<size_t>(begin)]) {
      stretches.led.push_back({begin, end});
    } else {
      for (int t = begin; t + length <= end; t += length) {
        stretches.not_led.push_back({t, t + length});
      }
    }
    begin = end;
  }
  return stretches;
}

engine::LabelTrack LabelsWithTurn(const dataset::Sequence& take, int classes, int turn_class,
                                  const std::vector<FrameSpan>& stretches, double weight) {
  const engine::LabelTrack captured = TimeLineLabels(take, classes);
  std::vector<engine::LabelKeyframe> keyframes;
  for (int t = 0; t < take.pair.leader.frame_count(); ++t) {
    std::vector<float> weights(static_cast<size_t>(classes));
    captured.At(t, weights.data());
    const bool asked = std::any_of(
        stretches.begin(), stretches.end(),
        [t](const FrameSpan& stretch) { return stretch.begin <= t && t < stretch.end; });
    if (asked) {
      std::fill(weights.begin(), weights.end(), 0.0f);
      weights[static_cast<size_t>(turn_class)] = static_cast<float>(weight);
    }
    keyframes.push_back({t, std::move(weights)});
  }
  return engine::LabelTrack(std::move(keyframes));
}

int CountTurned(const std::vector<FrameSpan>& stretches, const std::vector<metrics::Turn>& turns,
                double frame_rate_hz) {
  return static_cast<int>(
      std::count_if(stretches.begin(), stretches.end(), [&](const FrameSpan& stretch) {
        return std::any_of(turns.begin(), turns.end(), [&](const metrics::Turn& turn) {
          const double frame = turn.middle() * frame_rate_hz;
          return stretch.begin <= frame && frame < stretch.end;
        });
      }));
}

}  // namespace duet::evaluation::experiments

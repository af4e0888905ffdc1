#include "model/training/live_leader.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "model/engine/resting_leader.h"

namespace duet::training {
namespace {

// A random number of frames of up to `seconds`.
int DrawFrames(double seconds, double frame_rate_hz, base::Random* random) {
  const auto most = static_cast<int64_t>(std::lround(seconds * frame_rate_hz));
  return static_cast<int>(random->Below(most + 1));
}

int KnownFrames(const engine::NetworkInput& input) {
  if (!input.settled.empty()) return input.settled.frame_count();
  return input.start && !input.start->pose.empty() ? 1 : 0;
}

void Shorten(int frames, FlowExample* example) {
  const std::size_t classes =
      example->input.labels.size() / static_cast<std::size_t>(example->target.frame_count());
  example->target.Resize(frames);
  example->input.leader.Resize(frames);
  example->input.labels.resize(static_cast<std::size_t>(frames) * classes);
}

// Gives the frames after `now` the labels of `now`.
void KeepLabels(int now, int frames, std::vector<float>* labels) {
  const auto classes = static_cast<std::ptrdiff_t>(labels->size()) / frames;
  for (int t = now + 1; t < frames; ++t) {
    std::copy_n(labels->begin() + now * classes, classes, labels->begin() + t * classes);
  }
}

}  // namespace

void HideFuture(const motion::Skeleton& skeleton, double frame_rate_hz,
                const FlowTraining::Live& live, base::Random* random, FlowExample* example) {
  engine::NetworkInput& input = example->input;
  const int last_known = std::max(0, KnownFrames(input) - 1);
  const int now = last_known + DrawFrames(live.remade_seconds, frame_rate_hz, random);
  const int newest = now + DrawFrames(live.delay_seconds, frame_rate_hz, random);
  const int future = static_cast<int>(std::lround(live.future_seconds * frame_rate_hz));
  const int frames = std::min(input.leader.frame_count(), now + 1 + future);
  Shorten(frames, example);
  if (now < frames) KeepLabels(now, frames, &input.labels);
  if (newest + 1 >= frames) return;
  input.hidden_frames = frames - newest - 1;
  std::vector<double> unknown;
  for (int t = newest + 1; t < frames; ++t) unknown.push_back((t - newest) / frame_rate_hz);
  input.leader.Resize(newest + 1);
  input.leader.Append(engine::ComeToRest(skeleton, input.leader, frame_rate_hz, unknown).all());
}

}  // namespace duet::training

#include "tests/support/fake_synthesizer.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace duet::test {

engine::ModelDescription FakeDescription() {
  engine::ModelDescription description;
  description.name = "fake";
  description.version = 1;
  description.description = "Answers by a known rule";
  description.skeleton = motion::SbuSkeleton();
  description.classes = {"kick", "push", "shake_hands", "hug", "exchange_object", "punch"};
  description.touching_classes = {"hug"};
  description.frame_rate_hz = 15;
  description.window_frames = 46;
  description.accepts_follower_start = true;
  return description;
}

engine::ModelDescription SamplingDescription() {
  engine::ModelDescription description = FakeDescription();
  description.name = "fake_sampler";
  description.samples = true;
  return description;
}

motion::Vec3 FakeDraw(const engine::Sampling& sampling) {
  return {sampling.variety * static_cast<float>(sampling.seed % 997) / 997, 0, 0};
}

motion::Vec3 FakeAnswer(motion::Vec3 leader, absl::Span<const float> labels) {
  float lift = 0;
  for (float weight : labels) lift += weight;
  return {0.25f - leader.x, leader.y + lift, -1.5f - leader.z};
}

FakeSynthesizer::FakeSynthesizer(engine::ModelDescription description)
    : description_(std::move(description)) {}

std::vector<engine::WindowResult> FakeSynthesizer::Synthesize(
    absl::Span<const engine::SynthesisWindow* const> windows) const {
  if (on_batch) on_batch(windows);
  std::vector<engine::WindowResult> results;
  for (const engine::SynthesisWindow* window : windows) results.push_back(Answer(*window));
  return results;
}

engine::WindowResult FakeSynthesizer::Answer(const engine::SynthesisWindow& window) const {
  if (window_status) {
    if (absl::Status status = window_status(window); !status.ok()) return status;
  }
  const std::size_t classes = description_.classes.size();
  motion::Poses follower = window.leader;
  for (int t = 0; t < follower.frame_count(); ++t) {
    const absl::Span<const float> labels(
        window.labels.data() + static_cast<std::size_t>(t) * classes, classes);
    for (motion::Vec3& position : follower[t]) position = answer(position, labels);
  }
  if (description_.samples) Draw(window, &follower);
  return follower;
}

void FakeSynthesizer::Draw(const engine::SynthesisWindow& window, motion::Poses* follower) {
  for (motion::Vec3& position : follower->all()) position += FakeDraw(window.options.sampling);
  std::copy(window.settled.all().begin(), window.settled.all().end(), follower->all().begin());
}

std::optional<double> FakeSynthesizer::Unfamiliarity(const engine::ClipRequest& request) const {
  if (!unfamiliarity) return std::nullopt;
  return unfamiliarity(request);
}

}  // namespace duet::test

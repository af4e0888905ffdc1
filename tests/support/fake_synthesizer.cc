#include "tests/support/fake_synthesizer.h"

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
  description.frame_rate_hz = 15;
  description.window_frames = 46;
  description.accepts_follower_start = true;
  return description;
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
  const std::size_t joints = description_.skeleton.joint_names.size();
  const std::size_t classes = description_.classes.size();
  std::vector<motion::Vec3> follower(window.leader.size());
  for (std::size_t i = 0; i < follower.size(); ++i) {
    const absl::Span<const float> labels(window.labels.data() + i / joints * classes, classes);
    follower[i] = answer(window.leader[i], labels);
  }
  return follower;
}

}  // namespace duet::test

#include "tests/support/tiny_checkpoint.h"

#include <cstddef>
#include <string>
#include <utility>

namespace duet::test {

checkpoint::Manifest TinyManifest() {
  checkpoint::Manifest manifest;
  manifest.model.name = "tiny";
  manifest.model.version = 3;
  manifest.model.description = "Three joints, for tests";
  manifest.model.frame_rate_hz = 15;
  manifest.model.window_frames = 8;
  manifest.model.classes = {"kick", "hug"};
  manifest.model.skeleton.joint_names = {"torso", "left_hip", "right_hip"};
  manifest.model.skeleton.bones = {{0, 1}, {0, 2}};
  manifest.model.skeleton.root = 0;
  manifest.model.skeleton.hips = manifest.model.skeleton.feet = motion::JointPair{1, 2};
  manifest.model.accepts_follower_start = true;
  manifest.parts = {{"trunk", {0}}, {"legs", {1, 2}}};
  checkpoint::PaperArchitecture paper;
  paper.follower_start = true;
  paper.slice_features = 1;
  paper.encoder_hidden = 2;
  paper.attention = 2;
  paper.base_pose = true;
  manifest.architecture = paper;
  manifest.git_revision = "0123abc";
  manifest.created = "2024-02-29T12:00:00Z";
  manifest.training = {{"data", "none"}, {"epochs", "0"}};
  manifest.metrics = {{"afd.kick", 0.5}, {"afd.hug", 0.625}};
  return manifest;
}

checkpoint::Manifest CompleteManifest() {
  checkpoint::Manifest manifest = TinyManifest();
  manifest.weights.bytes = 1234;
  manifest.weights.sha256 = std::string(64, 'a');
  return manifest;
}

checkpoint::Checkpoint FilledCheckpoint(checkpoint::Manifest manifest) {
  checkpoint::Checkpoint checkpoint;
  checkpoint.manifest = std::move(manifest);
  for (checkpoint::TensorSpec& spec : ExpectedTensors(checkpoint.manifest)) {
    std::size_t count = 1;
    for (int64_t size : spec.shape) count *= static_cast<std::size_t>(size);
    const std::size_t k = checkpoint.tensors.size();
    checkpoint::Tensor tensor{std::move(spec.name), std::move(spec.shape), {}};
    for (std::size_t i = 0; i < count; ++i) {
      tensor.values.push_back((static_cast<float>((31 * k + 7 * i) % 17) - 8) / 16);
    }
    checkpoint.tensors.push_back(std::move(tensor));
  }
  return checkpoint;
}

}  // namespace duet::test

#ifndef DUET_TESTS_NETWORK_FLOW_TEST_SUPPORT_H_
#define DUET_TESTS_NETWORK_FLOW_TEST_SUPPORT_H_

#include <cmath>
#include <cstdint>
#include <vector>

#include "model/network/flow_generator.h"
#include "tests/network/test_manifest.h"
#include "tests/support/architectures.h"

namespace duet::network {

// A sampling generator small enough for a test.
inline checkpoint::Manifest SmallFlowManifest() {
  checkpoint::Manifest manifest = SmallManifest();
  SetArchitecture(test::SmallFlow(), &manifest);
  return manifest;
}

// A generator with weights with which every input has an effect.
inline FlowGenerator RandomFlowGenerator(const checkpoint::Manifest& manifest) {
  torch::manual_seed(1);
  FlowGenerator generator(manifest);
  torch::NoGradGuard no_grad;
  for (torch::Tensor& parameter : generator->parameters()) parameter.uniform_(-0.5, 0.5);
  const int64_t classes = manifest.model.class_count(), width = generator->base_poses().size(1);
  generator->SetMeasured(torch::rand({classes, width}),
                         torch::eye(width).expand({2, width, width}));
  generator->eval();
  return generator;
}

// A swaying leader with one class in all frames.
inline engine::NetworkInput FlowWindow(const checkpoint::Manifest& manifest, int frames,
                                       int interaction_class = 0, float weight = 1) {
  const int joints = manifest.model.skeleton.joint_count();
  const int classes = manifest.model.class_count();
  engine::NetworkInput input;
  input.leader = motion::Poses(frames, joints);
  for (int t = 0; t < frames; ++t) {
    for (int j = 0; j < joints; ++j) {
      const float phase = 0.3f * static_cast<float>(t) + static_cast<float>(j);
      input.leader.at(t, j) = {0.3f * std::sin(phase), 0.1f * static_cast<float>(j), 0.2f};
    }
  }
  input.labels.assign(static_cast<size_t>(frames * classes), 0);
  for (int t = 0; t < frames; ++t) {
    input.labels[static_cast<size_t>(t * classes + interaction_class)] = weight;
  }
  return input;
}

// `frames` frames of a follower that walks away, starting one metre in front of the leader.
inline motion::Poses SettledFrames(const checkpoint::Manifest& manifest, int frames) {
  motion::Poses settled(frames, manifest.model.skeleton.joint_count());
  for (int t = 0; t < frames; ++t) {
    for (int j = 0; j < settled.joint_count(); ++j) {
      settled.at(t, j) = {0.01f * static_cast<float>(j), 0.1f * static_cast<float>(j),
                          -1.0f - 0.05f * static_cast<float>(t)};
    }
  }
  return settled;
}

inline engine::FollowerStart StartAt(const motion::Poses& poses, int root) {
  return {poses.at(0, root), {poses[0].begin(), poses[0].end()}};
}

}  // namespace duet::network

#endif  // DUET_TESTS_NETWORK_FLOW_TEST_SUPPORT_H_

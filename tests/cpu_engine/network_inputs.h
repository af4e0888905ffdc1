#ifndef DUET_TESTS_CPU_ENGINE_NETWORK_INPUTS_H_
#define DUET_TESTS_CPU_ENGINE_NETWORK_INPUTS_H_

#include <cstdint>
#include <vector>

#include "model/base/random.h"
#include "model/engine/network.h"
#include "tests/network/test_manifest.h"
#include "tests/support/architectures.h"

// Small generators of both architectures, and windows for them to answer.

namespace duet::cpu_engine {

inline checkpoint::Manifest PaperManifest(checkpoint::GeneratorVariant variant, int slice_features,
                                          bool start, bool base) {
  checkpoint::Manifest manifest = network::SmallManifest(start);
  manifest.model.window_frames = 33;
  test::PaperOf(manifest).variant = variant;
  test::PaperOf(manifest).slice_features = slice_features;
  test::PaperOf(manifest).encoder_hidden = 7;
  test::PaperOf(manifest).attention = 19;
  test::PaperOf(manifest).base_pose = base;
  return manifest;
}

inline checkpoint::Manifest FlowManifest() {
  checkpoint::Manifest manifest = network::SmallManifest();
  manifest.model.window_frames = 33;
  SetArchitecture(test::SmallFlow(), &manifest);
  test::FlowOf(manifest).blocks = 4;
  test::FlowOf(manifest).width = 36;
  test::FlowOf(manifest).heads = 3;
  test::FlowOf(manifest).feed_forward = 50;
  test::FlowOf(manifest).reach = 9;  // less than a window
  test::FlowOf(manifest).guidance = 1.7;
  return manifest;
}

// A synthetic person near the origin, with the model's joints.
inline motion::Poses Person(int frames, int joints, base::Random* random) {
  motion::Poses person(frames, joints);
  for (int j = 0; j < joints; ++j) {
    motion::Vec3 at{static_cast<float>(random->Uniform(-0.5, 0.5)),
                    static_cast<float>(random->Uniform(0, 1.7)),
                    static_cast<float>(random->Uniform(-0.3, 0.3))};
    for (int t = 0; t < frames; ++t) {
      for (float* value : {&at.x, &at.y, &at.z}) {
        *value += static_cast<float>(random->Normal(0.02));
      }
      person.at(t, j) = at;
    }
  }
  return person;
}

// What a window tells of the follower: its first root, its first pose, or its first frames.
enum class Told { kNothing, kRoot, kPose, kSettled };

inline engine::NetworkInput Input(const checkpoint::Manifest& manifest, int frames, Told told,
                                  uint64_t seed) {
  base::Random random(seed);
  const int joints = manifest.model.skeleton.joint_count();
  engine::NetworkInput input;
  input.leader = Person(frames, joints, &random);
  // Graded, mixed and avoided labels, some of them changing.
  for (int t = 0; t < frames; ++t) {
    for (int c = 0; c < manifest.model.class_count(); ++c) {
      const double weight = c == 0 ? 1.0 - 0.5 * t / frames : c == 1 ? -0.3 : c == 2 ? 0.6 : 0;
      input.labels.push_back(static_cast<float>(weight));
    }
  }
  input.sampling = {seed, 1};
  const motion::Poses follower = Person(frames, joints, &random);
  const motion::Vec3 root = follower.at(0, manifest.model.skeleton.root);
  if (told == Told::kRoot) input.start = engine::FollowerStart{root, {}};
  if (told == Told::kPose || told == Told::kSettled) {
    input.start = engine::FollowerStart{root, {follower[0].begin(), follower[0].end()}};
  }
  if (told == Told::kSettled && manifest.model.samples && frames > 6) {
    input.settled =
        motion::Poses(joints, {follower.frames(0, 5).begin(), follower.frames(0, 5).end()});
  }
  return input;
}

// Windows of several lengths and with every kind of start.
inline std::vector<engine::NetworkInput> Inputs(const checkpoint::Manifest& manifest) {
  const int longest = manifest.model.window_frames;
  std::vector<engine::NetworkInput> inputs;
  uint64_t seed = 1;
  for (const int frames : {longest, 2, longest / 2, 7, longest}) {
    for (const Told told : {Told::kNothing, Told::kRoot, Told::kPose, Told::kSettled}) {
      inputs.push_back(Input(manifest, frames, told, seed++));
    }
  }
  return inputs;
}

}  // namespace duet::cpu_engine

#endif  // DUET_TESTS_CPU_ENGINE_NETWORK_INPUTS_H_

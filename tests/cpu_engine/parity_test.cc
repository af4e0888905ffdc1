// Compares the answers of this project's kernels and of LibTorch to the same windows.
#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <string>

#include "model/cpu_engine/cpu_synthesizer.h"
#include "model/embedded/embedded.h"
#include "model/motion/skeleton.h"
#include "model/network/torch_network.h"
#include "tests/cpu_engine/network_inputs.h"
#include "tests/cpu_engine/random_checkpoint.h"
#include "tests/support/architectures.h"
#include "tests/support/matchers.h"
#include "tests/support/sample_motion.h"

namespace duet::cpu_engine {
namespace {

using checkpoint::Checkpoint;
using checkpoint::GeneratorVariant;
using checkpoint::Manifest;
using engine::NetworkInput;
using kernels::Precision;

std::vector<Checkpoint> Embedded() {
  std::vector<Checkpoint> checkpoints;
  for (const embedded::EmbeddedCheckpoint& embedded : embedded::EmbeddedCheckpoints()) {
    auto checkpoint = checkpoint::ParseCheckpoint(embedded.manifest, embedded.weights);
    EXPECT_THAT(checkpoint, IsOk());
    if (checkpoint.ok()) checkpoints.push_back(*std::move(checkpoint));
  }
  return checkpoints;
}

std::vector<motion::Poses> Answers(const engine::Network& network,
                                   absl::Span<const NetworkInput> inputs) {
  auto answers = network.Run(inputs);
  EXPECT_THAT(answers, IsOk());
  return answers.ok() ? *std::move(answers) : std::vector<motion::Poses>();
}

// The maximum distance between the two answers of a joint, metres.
float Farthest(const std::vector<motion::Poses>& a, const std::vector<motion::Poses>& b) {
  EXPECT_EQ(a.size(), b.size());
  float farthest = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    EXPECT_EQ(a[i].all().size(), b[i].all().size());
    for (std::size_t k = 0; k < a[i].all().size(); ++k) {
      farthest = std::max(farthest, Distance(a[i].all()[k], b[i].all()[k]));
    }
  }
  return farthest;
}

float FromTorch(const Checkpoint& checkpoint, Precision precision,
                const std::vector<NetworkInput>& inputs) {
  const auto torch = network::MakeTorchNetwork(checkpoint);
  EXPECT_THAT(torch, IsOk());
  if (!torch.ok()) return 1e9f;
  return Farthest(Answers(**torch, inputs),
                  Answers(*MakeCpuNetwork(checkpoint, precision), inputs));
}

float FromTorch(const Checkpoint& checkpoint, Precision precision) {
  return FromTorch(checkpoint, precision, Inputs(checkpoint.manifest));
}

// A joint of a person, as an offset from a joint of the SBU skeleton.
struct NearJoint {
  const char* sbu;
  motion::Vec3 offset;
};

// Joints that the SBU skeleton lacks, or has under another name.
const std::map<std::string, NearJoint>& OtherJoints() {
  static const auto* const kJoints =
      new std::map<std::string, NearJoint>{{"hips", {"torso", {0, -0.15f, 0}}},
                                           {"spine", {"torso", {0, -0.05f, 0}}},
                                           {"chest", {"torso", {0, 0.1f, 0}}},
                                           {"head_top", {"head", {0, 0.18f, 0}}},
                                           {"left_wrist", {"left_hand", {0, 0.1f, 0}}},
                                           {"right_wrist", {"right_hand", {0, 0.1f, 0}}},
                                           {"left_ankle", {"left_foot", {}}},
                                           {"right_ankle", {"right_foot", {}}},
                                           {"left_toe", {"left_foot", {0, -0.06f, -0.15f}}},
                                           {"right_toe", {"right_foot", {0, -0.06f, -0.15f}}}};
  return *kJoints;
}

// A swaying person with the joints of `skeleton`.
motion::Poses SwayingPerson(const motion::Skeleton& skeleton, int frames, double frame_rate_hz) {
  const motion::Poses swaying = test::SwayingMotion(frames, frame_rate_hz);
  const std::vector<std::string>& sbu = motion::SbuSkeleton().joint_names;
  motion::Poses person(frames, skeleton.joint_count());
  for (int joint = 0; joint < skeleton.joint_count(); ++joint) {
    const std::string& name = skeleton.joint_names[static_cast<std::size_t>(joint)];
    const auto other = OtherJoints().find(name);
    const NearJoint near =
        other == OtherJoints().end() ? NearJoint{name.c_str(), {}} : other->second;
    const auto found = std::find(sbu.begin(), sbu.end(), near.sbu);
    EXPECT_NE(found, sbu.end()) << name;
    const auto from = static_cast<int>(found - sbu.begin()) % swaying.joint_count();
    for (int t = 0; t < frames; ++t) person.at(t, joint) = swaying.at(t, from) + near.offset;
  }
  return person;
}

// A swaying person near the origin, once with each class.
std::vector<NetworkInput> HumanInputs(const Manifest& manifest, int frames) {
  const int classes = manifest.model.class_count();
  std::vector<NetworkInput> inputs;
  for (int own = 0; own < classes; ++own) {
    NetworkInput input;
    input.leader = SwayingPerson(manifest.model.skeleton, frames, manifest.model.frame_rate_hz);
    const motion::Vec3 root = input.leader.at(0, manifest.model.skeleton.root);
    for (motion::Vec3& joint : input.leader.all()) joint = joint - root;
    for (int t = 0; t < frames; ++t) {
      for (int c = 0; c < classes; ++c) input.labels.push_back(c == own ? 1.0f : 0.0f);
    }
    inputs.push_back(std::move(input));
  }
  return inputs;
}

TEST(ParityTest, EmbeddedCheckpointsEqualLibTorch) {
  for (const Checkpoint& checkpoint : Embedded()) {
    EXPECT_LT(FromTorch(checkpoint, Precision::kFloat32), 1e-5f)
        << checkpoint.manifest.model.name << " " << checkpoint.manifest.model.version;
  }
}

TEST(ParityTest, WindowsOfAnEndlessMotionEqualLibTorch) {
  const Checkpoint checkpoint = RandomCheckpoint(FlowManifest(), 3);
  std::vector<NetworkInput> inputs = Inputs(checkpoint.manifest);
  for (NetworkInput& input : inputs) input.sampling.first_frame = 1000;
  EXPECT_LT(FromTorch(checkpoint, Precision::kFloat32, inputs), 1e-5f);
  const auto network = MakeCpuNetwork(checkpoint, Precision::kFloat32);
  const std::vector<motion::Poses> endless = Answers(*network, inputs);
  for (NetworkInput& input : inputs) input.sampling.first_frame = 1001;
  EXPECT_GT(Farthest(endless, Answers(*network, inputs)), 1e-3f);
}

TEST(ParityTest, EveryVariantOfThePaperGeneratorEqualsLibTorch) {
  uint64_t seed = 1;
  for (const GeneratorVariant variant :
       {GeneratorVariant::kPaper, GeneratorVariant::kReleased, GeneratorVariant::kUnlabelled}) {
    for (const int slice_features : {0, 5}) {
      for (const bool start : {false, true}) {
        for (const bool base : {false, true}) {
          const Manifest manifest = PaperManifest(variant, slice_features, start, base);
          EXPECT_LT(FromTorch(RandomCheckpoint(manifest, seed++), Precision::kFloat32), 1e-5f)
              << static_cast<int>(variant) << slice_features << start << base;
        }
      }
    }
  }
}

TEST(ParityTest, SamplingGeneratorOfOtherSizesEqualsLibTorch) {
  EXPECT_LT(FromTorch(RandomCheckpoint(FlowManifest(), 3), Precision::kFloat32), 1e-5f);
}

TEST(ParityTest, SamplingGeneratorWithFrameLabelsEqualsLibTorch) {
  Manifest manifest = FlowManifest();
  test::FlowOf(manifest).frame_labels = true;
  test::FlowOf(manifest).guidance = 1;
  const Checkpoint checkpoint = RandomCheckpoint(manifest, 3);
  EXPECT_LT(FromTorch(checkpoint, Precision::kFloat32), 1e-5f);
  // Labels that change within the window matter.
  std::vector<NetworkInput> changed = {Input(manifest, 9, Told::kPose, 1)};
  const auto network = MakeCpuNetwork(checkpoint, Precision::kFloat32);
  const std::vector<motion::Poses> before = Answers(*network, changed);
  changed[0].labels[5 * static_cast<std::size_t>(manifest.model.class_count())] = -1;
  EXPECT_GT(Farthest(before, Answers(*network, changed)), 1e-4f);
}

TEST(ParityTest, SamplingGeneratorThatReadsHiddenFramesEqualsLibTorch) {
  Manifest manifest = FlowManifest();
  test::FlowOf(manifest).hidden_frames = true;
  const Checkpoint checkpoint = RandomCheckpoint(manifest, 3);
  std::vector<NetworkInput> inputs = {Input(manifest, 9, Told::kPose, 1),
                                      Input(manifest, 5, Told::kPose, 2)};
  const auto network = MakeCpuNetwork(checkpoint, Precision::kFloat32);
  const std::vector<motion::Poses> before = Answers(*network, inputs);
  inputs[0].hidden_frames = 4;
  EXPECT_GT(Farthest(before, Answers(*network, inputs)), 1e-4f);
  EXPECT_LT(FromTorch(checkpoint, Precision::kFloat32, inputs), 1e-5f);
}

TEST(ParityTest, WideGeneratorEqualsLibTorch) {
  Manifest manifest = PaperManifest(GeneratorVariant::kPaper, 50, true, true);
  manifest.model.window_frames = 9;
  test::PaperOf(manifest).encoder_hidden = 200;  // a decoder of 1,200 units
  const Checkpoint checkpoint = RandomCheckpoint(manifest, 5);
  std::vector<NetworkInput> inputs;
  for (const int frames : {9, 4, 9}) inputs.push_back(Input(manifest, frames, Told::kRoot, 3));
  EXPECT_LT(FromTorch(checkpoint, Precision::kFloat32, inputs), 1e-5f);
  EXPECT_LT(FromTorch(checkpoint, Precision::kInt16, inputs), 2e-4f);
}

// The maximum shift of a joint by rounded weights, metres. Of models that sample, it is larger: a
// swaying person is unlike every leader that salsa was trained on, for example.
float MaximumShift(const Manifest& manifest) {
  if (!manifest.model.samples) return 2.5e-4f;
  return manifest.model.name == "salsa" ? 1.25e-3f : 6.25e-4f;
}

TEST(ParityTest, RoundedWeightsMoveJointsLittle) {
  for (const Checkpoint& checkpoint : Embedded()) {
    const float farthest =
        FromTorch(checkpoint, Precision::kInt16,
                  HumanInputs(checkpoint.manifest, checkpoint.manifest.model.window_frames));
    EXPECT_LT(farthest, MaximumShift(checkpoint.manifest))
        << checkpoint.manifest.model.name << " " << checkpoint.manifest.model.version;
    EXPECT_GT(farthest, 1e-6f);  // the precision is different
  }
}

TEST(ParityTest, AnswersAreBitIdenticalInAnyBatch) {
  for (const Checkpoint& checkpoint : Embedded()) {
    const std::vector<NetworkInput> inputs = Inputs(checkpoint.manifest);
    for (const Precision precision : {Precision::kFloat32, Precision::kInt16}) {
      const auto network = MakeCpuNetwork(checkpoint, precision);
      const std::vector<motion::Poses> together = Answers(*network, inputs);
      ASSERT_EQ(together.size(), inputs.size());
      for (std::size_t i = 0; i < inputs.size(); ++i) {
        EXPECT_EQ(Answers(*network, {&inputs[i], 1}).front(), together[i]) << i;
      }
    }
  }
}

}  // namespace
}  // namespace duet::cpu_engine

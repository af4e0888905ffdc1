#include "model/training/own_history.h"

#include <gtest/gtest.h>

#include "model/motion/limb_lengths.h"
#include "tests/support/sample_motion.h"

namespace duet::training {
namespace {

using motion::Poses;

constexpr int kFrames = 30, kKnown = 10;
const motion::Vec3 kAside = {0.5f, 0, 0};

std::vector<FlowExample> Examples(int count, int known) {
  FlowExample example;
  example.input.leader = test::SwayingMotion(kFrames, 15);
  example.target = example.input.leader;
  example.input.settled = example.target;
  example.input.settled.Resize(known);
  return std::vector<FlowExample>(static_cast<size_t>(count), example);
}

// A network that answers with the captured motion, moved aside.
std::vector<Poses> Aside(absl::Span<const engine::NetworkInput> inputs) {
  std::vector<Poses> answers;
  for (const engine::NetworkInput& input : inputs) {
    answers.push_back(input.leader);
    for (motion::Vec3& point : answers.back().all()) point += kAside;
  }
  return answers;
}

FlowTraining::Own Always() {
  FlowTraining::Own own;
  own.share = 1;
  own.most_frames = 4;
  own.return_frames = 8;
  return own;
}

FlowExample Continued(const FlowTraining::Own& own, uint64_t seed) {
  base::Random random(seed);
  std::vector<FlowExample> examples = Examples(1, kKnown);
  ContinueOwnMotion(motion::SbuSkeleton(), own, Aside, &random, &examples);
  return examples[0];
}

float Off(const Poses& poses, int frame) {
  const Poses captured = test::SwayingMotion(kFrames, 15);
  float most = 0;
  for (int j = 0; j < poses.joint_count(); ++j) {
    most = std::max(most, Distance(poses.at(frame, j), captured.at(frame, j)));
  }
  return most;
}

TEST(ContinueOwnMotion, TheLastKnownFramesAreTheNetworksOwn) {
  bool shortest = false, longest = false;
  for (uint64_t seed = 0; seed < 100; ++seed) {
    const FlowExample example = Continued(Always(), seed);
    const Poses& known = example.input.settled;
    ASSERT_EQ(known.frame_count(), kKnown);
    int own = 0;
    while (own < kKnown && Off(known, kKnown - 1 - own) > 0.4f) ++own;
    ASSERT_GE(own, 1);
    ASSERT_LE(own, 4);
    shortest |= own == 1;
    longest |= own == 4;
    for (int t = 0; t < kKnown - own; ++t) ASSERT_EQ(Off(known, t), 0);
  }
  EXPECT_TRUE(shortest);
  EXPECT_TRUE(longest);
}

TEST(ContinueOwnMotion, TargetReturnsToTheCapturedMotion) {
  const Poses target = Continued(Always(), 3).target;
  EXPECT_EQ(target.frame_count(), kFrames);
  EXPECT_FLOAT_EQ(Off(target, kKnown - 1), kAside.x);
  for (int t = kKnown; t < kKnown + 8; ++t) EXPECT_LT(Off(target, t), Off(target, t - 1)) << t;
  for (int t = kKnown + 8; t < kFrames; ++t) EXPECT_LT(Off(target, t), 1e-5f) << t;
}

TEST(ContinueOwnMotion, ReturningLimbsKeepTheirLengths) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  const std::vector<float> captured = MedianBoneLengths(skeleton, test::SwayingMotion(kFrames, 15));
  base::Random random(1);
  std::vector<FlowExample> examples = Examples(1, kKnown);
  const Answer stretched = [](absl::Span<const engine::NetworkInput> inputs) {
    Poses twice = inputs[0].leader;
    for (motion::Vec3& point : twice.all()) point = point * 2;
    return std::vector<Poses>{twice};
  };
  ContinueOwnMotion(skeleton, Always(), stretched, &random, &examples);
  Poses after(0, skeleton.joint_count());
  after.Append(examples[0].target[kKnown]);
  const std::vector<float> lengths = MedianBoneLengths(skeleton, after);
  for (size_t b = 0; b < lengths.size(); ++b) EXPECT_NEAR(lengths[b], captured[b], 1e-4f) << b;
}

TEST(ContinueOwnMotion, ExamplesWithFewerThanTwoKnownFramesStay) {
  base::Random random(1);
  std::vector<FlowExample> examples = Examples(3, 1);
  bool asked = false;
  ContinueOwnMotion(
      motion::SbuSkeleton(), Always(),
      [&](absl::Span<const engine::NetworkInput> inputs) {
        asked = true;
        return Aside(inputs);
      },
      &random, &examples);
  EXPECT_FALSE(asked);
  EXPECT_EQ(Off(examples[0].target, kFrames - 1), 0);
}

TEST(ContinueOwnMotion, ChoosesAboutTheirShare) {
  FlowTraining::Own own = Always();
  own.share = 0.25;
  base::Random random(1);
  std::vector<FlowExample> examples = Examples(400, kKnown);
  ContinueOwnMotion(motion::SbuSkeleton(), own, Aside, &random, &examples);
  int chosen = 0;
  for (const FlowExample& example : examples) chosen += Off(example.target, kKnown - 1) > 0.4f;
  EXPECT_GT(chosen, 70);
  EXPECT_LT(chosen, 130);
}

}  // namespace
}  // namespace duet::training

#include <gtest/gtest.h>

#include <cmath>

#include "absl/strings/str_cat.h"
#include "model/motion/limb_lengths.h"
#include "model/training/flow_batches.h"
#include "tests/support/sample_motion.h"
#include "tests/training/made_up_dataset.h"
#include "tests/training/test_options.h"

namespace duet::training {
namespace {

using motion::Poses;
using motion::Vec3;

constexpr double kRate = 15;
constexpr int kFrames = 40, kKnown = 8, kClasses = 2;
const Vec3 kAside = {0.5f, 0, 0};

// A follower that stands still, with some known first frames.
struct Told {
  motion::Skeleton skeleton = motion::SbuSkeleton();
  Poses captured;
  engine::NetworkInput input;
  Poses target;
};

Told Standing(int settled) {
  Told told;
  const dataset::Dataset dataset = MadeUpDataset();
  const absl::Span<const Vec3> pose = dataset.sequences[0].pair.follower.poses[0];
  told.captured = Poses(0, told.skeleton.joint_count());
  for (int t = 0; t < 30; ++t) told.captured.Append(pose);
  told.target = told.captured;
  told.input.start = engine::FollowerStart{pose[static_cast<size_t>(told.skeleton.root)],
                                           {pose.begin(), pose.end()}};
  if (settled > 0) {
    told.input.settled = told.captured;
    told.input.settled.Resize(settled);
  }
  return told;
}

void Drift(const FlowSettings::Drift& options, Told* told) {
  base::Random random(1, 0);
  AddDrift(told->skeleton, options, &random, &told->input, &told->target);
}

float Off(const Poses& poses, const Poses& captured, int frame) {
  float most = 0;
  for (int j = 0; j < poses.joint_count(); ++j) {
    most = std::max(most, Distance(poses.at(frame, j), captured.at(frame, j)));
  }
  return most;
}

constexpr char kNoDrift[] = "tilt: 0 bend: 0 turn: 0 root: 0 height: 0 joints: 0";

TEST(Drift, TargetReturnsFromEachErrorToTheCapturedMotion) {
  for (const char* error : {"tilt", "bend", "turn", "root", "height", "joints"}) {
    FlowSettings::Drift options = Settings<FlowSettings::Drift>(kNoDrift);
    Change(absl::StrCat(error, ": 0.3 frames: 10"), &options);
    Told told = Standing(4);
    Drift(options, &told);
    for (int t = 0; t < 4; ++t) {
      EXPECT_GT(Off(told.target, told.captured, t), 0.01f);
      for (int j = 0; j < told.target.joint_count(); ++j) {
        EXPECT_LT(Distance(told.target.at(t, j), told.input.settled.at(t, j)), 1e-5f);
      }
    }
    EXPECT_LT(Off(told.target, told.captured, 9), Off(told.target, told.captured, 3));
    EXPECT_GT(Off(told.target, told.captured, 9), 0);
    for (int t = 13; t < 30; ++t) EXPECT_EQ(Off(told.target, told.captured, t), 0);
  }
}

TEST(Drift, BendDoesNotMoveTheLegs) {
  FlowSettings::Drift options = Settings<FlowSettings::Drift>(kNoDrift);
  options.set_bend(0.5);
  Told told = Standing(2);
  Drift(options, &told);
  for (const char* name : {"left_knee", "left_foot", "right_knee", "right_foot"}) {
    const int joint = told.skeleton.Find(name);
    EXPECT_EQ(told.target.at(0, joint), told.captured.at(0, joint)) << name;
  }
  const int head = told.skeleton.Find("head");
  EXPECT_GT(Distance(told.target.at(0, head), told.captured.at(0, head)), 0.05f);
}

// A swaying pair of which `known` follower frames are told, labels that differ in every frame.
FlowExample Swaying(int known) {
  FlowExample example;
  example.input.leader = test::SwayingMotion(kFrames, kRate);
  example.target = example.input.leader;
  example.input.settled = example.target;
  example.input.settled.Resize(known);
  for (int t = 0; t < kFrames; ++t) {
    example.input.labels.push_back(static_cast<float>(t));
    example.input.labels.push_back(static_cast<float>(-t));
  }
  return example;
}

FlowExample Hidden(const FlowSettings::Live& live, int known, uint64_t seed) {
  base::Random random(seed);
  FlowExample example = Swaying(known);
  HideFuture(motion::SbuSkeleton(), kRate, live, &random, &example);
  return example;
}

// The number of first frames in which two leaders agree.
int CommonFrames(const Poses& a, const Poses& b) {
  int count = 0;
  while (count < a.frame_count() && a[count] == b[count]) ++count;
  return count;
}

FlowSettings::Live ExactlyAtTheLastKnownFrame() {
  return Settings<FlowSettings::Live>("remade_seconds: 0 delay_seconds: 0 future_seconds: 1");
}

TEST(HideFuture, LeaderComesToRestLabelsStayAndTheTargetGoesOn) {
  const FlowExample captured = Swaying(kKnown);
  const FlowExample example = Hidden(ExactlyAtTheLastKnownFrame(), kKnown, 1);
  const Poses& leader = example.input.leader;
  EXPECT_EQ(leader.frame_count(), kKnown + 15);  // a second of future
  EXPECT_EQ(CommonFrames(leader, captured.input.leader), kKnown);
  EXPECT_EQ(example.input.hidden_frames, 15);
  const int last = leader.frame_count() - 1;
  EXPECT_LT(Distance(leader.at(last, 0), leader.at(last - 1, 0)), 1e-3f);
  EXPECT_EQ(CommonFrames(example.target, captured.target), leader.frame_count());
  const std::vector<float>& labels = example.input.labels;
  ASSERT_EQ(labels.size(), static_cast<size_t>(leader.frame_count() * kClasses));
  for (int t = 0; t < leader.frame_count(); ++t) {
    EXPECT_EQ(labels[static_cast<size_t>(t * kClasses)], std::min(t, kKnown - 1));
  }
}

TEST(HideFuture, PresentAndDelayAreDrawnUpToTheirMost) {
  FlowSettings::Live live;
  live.set_remade_seconds(4 / kRate);
  live.set_delay_seconds(3 / kRate);
  const Poses captured = Swaying(kKnown).input.leader;
  int least = kFrames, most = 0;
  for (uint64_t seed = 0; seed < 200; ++seed) {
    const int common = CommonFrames(Hidden(live, kKnown, seed).input.leader, captured);
    least = std::min(least, common);
    most = std::max(most, common);
  }
  EXPECT_EQ(least, kKnown);
  EXPECT_EQ(most, kKnown + 4 + 3);
}

TEST(HideFuture, ASessionThatBeginsKnowsTheFirstFrame) {
  const Poses captured = Swaying(0).input.leader;
  const FlowExample example = Hidden(ExactlyAtTheLastKnownFrame(), 0, 1);
  EXPECT_EQ(CommonFrames(example.input.leader, captured), 1);
  EXPECT_EQ(example.input.leader[1], captured[0]);  // a velocity needs two frames
}

// A network that answers with the captured motion, moved aside.
std::vector<Poses> Aside(absl::Span<const engine::NetworkInput> inputs) {
  std::vector<Poses> answers;
  for (const engine::NetworkInput& input : inputs) {
    answers.push_back(input.leader);
    for (Vec3& point : answers.back().all()) point += kAside;
  }
  return answers;
}

FlowSettings::Own Always() {
  return Settings<FlowSettings::Own>("share: 1 most_frames: 4 return_frames: 8");
}

FlowExample Continued(const FlowSettings::Own& own, uint64_t seed) {
  base::Random random(seed);
  std::vector<FlowExample> examples = {Swaying(kKnown)};
  ContinueOwnMotion(motion::SbuSkeleton(), own, Aside, &random, &examples);
  return examples[0];
}

float OffSwaying(const Poses& poses, int frame) {
  return Off(poses, test::SwayingMotion(kFrames, kRate), frame);
}

TEST(ContinueOwnMotion, TheLastKnownFramesAreTheNetworksOwn) {
  bool shortest = false, longest = false;
  for (uint64_t seed = 0; seed < 100; ++seed) {
    const FlowExample example = Continued(Always(), seed);
    const Poses& known = example.input.settled;
    ASSERT_EQ(known.frame_count(), kKnown);
    int own = 0;
    while (own < kKnown && OffSwaying(known, kKnown - 1 - own) > 0.4f) ++own;
    ASSERT_GE(own, 1);
    ASSERT_LE(own, 4);
    shortest |= own == 1;
    longest |= own == 4;
    for (int t = 0; t < kKnown - own; ++t) ASSERT_EQ(OffSwaying(known, t), 0);
  }
  EXPECT_TRUE(shortest);
  EXPECT_TRUE(longest);
}

TEST(ContinueOwnMotion, TargetReturnsToTheCapturedMotion) {
  const Poses target = Continued(Always(), 3).target;
  EXPECT_EQ(target.frame_count(), kFrames);
  EXPECT_FLOAT_EQ(OffSwaying(target, kKnown - 1), kAside.x);
  for (int t = kKnown; t < kKnown + 8; ++t)
    EXPECT_LT(OffSwaying(target, t), OffSwaying(target, t - 1)) << t;
  for (int t = kKnown + 8; t < kFrames; ++t) EXPECT_LT(OffSwaying(target, t), 1e-5f) << t;
}

TEST(ContinueOwnMotion, ReturningLimbsKeepTheirLengths) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  const std::vector<float> captured =
      MedianBoneLengths(skeleton, test::SwayingMotion(kFrames, kRate));
  base::Random random(1);
  std::vector<FlowExample> examples = {Swaying(kKnown)};
  const Answer stretched = [](absl::Span<const engine::NetworkInput> inputs) {
    Poses twice = inputs[0].leader;
    for (Vec3& point : twice.all()) point = point * 2;
    return std::vector<Poses>{twice};
  };
  ContinueOwnMotion(skeleton, Always(), stretched, &random, &examples);
  Poses after(0, skeleton.joint_count());
  after.Append(examples[0].target[kKnown]);
  const std::vector<float> lengths = MedianBoneLengths(skeleton, after);
  for (size_t b = 0; b < lengths.size(); ++b) EXPECT_NEAR(lengths[b], captured[b], 1e-4f) << b;
}

}  // namespace
}  // namespace duet::training

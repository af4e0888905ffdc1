#include "model/training/drift.h"

#include <gtest/gtest.h>

#include <cmath>

#include "model/motion/limb_lengths.h"
#include "tests/training/made_up_dataset.h"

namespace duet::training {
namespace {

using motion::Poses;
using motion::Vec3;

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

void Drift(const FlowTraining::Drift& options, Told* told) {
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

TEST(Drift, TargetReturnsFromEachErrorToTheCapturedMotion) {
  using Options = FlowTraining::Drift;
  for (double Options::*error : {&Options::tilt, &Options::bend, &Options::turn, &Options::twist,
                                 &Options::root, &Options::height, &Options::joints}) {
    Options options;
    options.*error = 0.3;
    options.frames = 10;
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

TEST(Drift, StartHasTheError) {
  FlowTraining::Drift options;
  options.root = options.joints = 0.3;
  Told told = Standing(0);
  Drift(options, &told);
  const std::vector<Vec3>& pose = told.input.start->pose;
  EXPECT_EQ(told.input.start->root, pose[static_cast<size_t>(told.skeleton.root)]);
  EXPECT_GT(Distance(pose[0], told.captured.at(0, 0)), 0.01f);
}

TEST(Drift, BendDoesNotMoveTheLegs) {
  FlowTraining::Drift options;
  options.bend = 0.5;
  Told told = Standing(2);
  Drift(options, &told);
  for (const char* name : {"left_knee", "left_foot", "right_knee", "right_foot"}) {
    const int joint = told.skeleton.Find(name);
    EXPECT_EQ(told.target.at(0, joint), told.captured.at(0, joint)) << name;
  }
  const int head = told.skeleton.Find("head");
  EXPECT_GT(Distance(told.target.at(0, head), told.captured.at(0, head)), 0.05f);
}

TEST(Drift, TwistTurnsWhatIsAboveTheHips) {
  FlowTraining::Drift options;
  options.twist = 0.6;
  Told told = Standing(2);
  Drift(options, &told);
  for (const char* name :
       {"torso", "left_hip", "left_knee", "left_foot", "right_hip", "right_knee", "right_foot"}) {
    const int joint = told.skeleton.Find(name);
    EXPECT_EQ(told.target.at(0, joint), told.captured.at(0, joint)) << name;
  }
  const auto shoulders = [&](const Poses& poses) {
    const Vec3 across = poses.at(0, told.skeleton.Find("right_shoulder")) -
                        poses.at(0, told.skeleton.Find("left_shoulder"));
    return std::atan2(across.x, across.z);
  };
  EXPECT_GT(std::abs(shoulders(told.target) - shoulders(told.captured)), 0.1);
  EXPECT_LT(std::abs(told.target.at(0, 0).y - told.captured.at(0, 0).y), 1e-6f);
  const std::vector<float> before = MedianBoneLengths(told.skeleton, told.captured);
  Poses first(0, told.skeleton.joint_count());
  first.Append(told.target[0]);
  const std::vector<float> after = MedianBoneLengths(told.skeleton, first);
  for (size_t b = 0; b < before.size(); ++b) EXPECT_NEAR(after[b], before[b], 1e-5f) << b;
}

}  // namespace
}  // namespace duet::training

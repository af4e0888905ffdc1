#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "model/training/augment.h"
#include "model/training/finishing.h"
#include "tests/training/made_up_dataset.h"

namespace duet::training {
namespace {

constexpr double kDegrees = M_PI / 180;

// A person at `root` whose hips face `yaw` from -z, and whose right hand gradually reaches half a
// metre in the direction `reach` from -z.
motion::Clip Reaching(motion::Vec3 root, double yaw, double reach) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  motion::Clip clip;
  clip.joint_names = skeleton.joint_names;
  clip.frame_rate_hz = 15;
  std::vector<motion::Vec3> standing = SwayingPose(0);
  const motion::Vec3 centre = standing[static_cast<size_t>(skeleton.root)];
  for (int t = 0; t < 10; ++t) {
    std::vector<motion::Vec3> pose = standing;
    for (motion::Vec3& p : pose) p = RotateY(p - centre, yaw - 0.5) + root;
    pose[static_cast<size_t>(skeleton.Find("right_hand"))] =
        root + motion::RotateY({0, 0.2f, -0.05f * static_cast<float>(t)}, reach);
    clip.Append(pose);
  }
  return clip;
}

// A leader that reaches for the follower. The hips are `off` degrees off; both are turned by
// `turn`.
dataset::Sequence Pair(double off, double turn) {
  const motion::Vec3 root = {1, 1, -2};
  const motion::Vec3 toward = motion::RotateY({0, 0, -1}, turn);
  dataset::Sequence sequence;
  sequence.pair.leader = Reaching(root, turn + off * kDegrees, turn);
  sequence.pair.follower = Reaching(root + toward, turn + M_PI, turn + M_PI);
  sequence.partner_direction = toward;
  return sequence;
}

dataset::Dataset Reachers() {
  dataset::Dataset dataset = MadeUpDataset(0);
  for (int off = -60; off <= 60; off += 8) dataset.sequences.push_back(Pair(off, 0.1 * off));
  return dataset;
}

double DegreesOff(const engine::DirectionRegression& regression, const motion::Clip& leader,
                  motion::Vec3 toward, const std::vector<float>& label = {}) {
  const std::optional<motion::Vec3> direction =
      EstimatePartnerDirection(regression, motion::SbuSkeleton(), leader.poses, label);
  if (!direction) return 180;
  return std::acos(std::min(1.0f, Dot(*direction, toward))) / kDegrees;
}

TEST(FitPartnerDirection, LearnsTheDirectionOfReaching) {
  const dataset::Dataset dataset = Reachers();
  const auto regression = FitPartnerDirection(dataset, AllOf(dataset));
  ASSERT_TRUE(regression.has_value());
  for (const double off : {-50.0, -21.0, 0.0, 33.0, 55.0}) {
    for (const double turn : {0.0, 1.0, 2.5}) {
      // A linear model approximates an angle, and the penalty biases it towards the hips.
      EXPECT_LT(
          DegreesOff(*regression, Pair(off, turn).pair.leader, motion::RotateY({0, 0, -1}, turn)),
          8 + std::abs(off) / 4)
          << off << " " << turn;
    }
  }
}

TEST(FitPartnerDirection, HipsThatTheCaptureReversedAreCorrected) {
  const dataset::Dataset dataset = Reachers();
  const auto regression = FitPartnerDirection(dataset, AllOf(dataset));
  ASSERT_TRUE(regression.has_value());
  for (const double off : {-30.0, 0.0, 25.0}) {
    motion::Clip leader = Pair(off, 0).pair.leader;
    for (int t = 0; t < leader.frame_count(); ++t) {
      std::swap(leader.at(t, dataset.skeleton.hips->left),
                leader.at(t, dataset.skeleton.hips->right));
    }
    EXPECT_LT(DegreesOff(*regression, leader, {0, 0, -1}), 25) << off;
  }
}

// In one class the partner is where the hand is, in the other one 50 degrees to its right.
TEST(FitPartnerDirection, ClassesDifferInWhereThePartnerIs) {
  dataset::Dataset dataset = Reachers();
  const std::size_t count = dataset.sequences.size();
  const motion::Vec3 ahead = {0, 0, -1}, aside = motion::RotateY(ahead, -50 * kDegrees);
  for (std::size_t i = 0; i < count; ++i) {
    dataset::Sequence other = dataset.sequences[i];
    other.interaction_class = 2;
    other.partner_direction = motion::RotateY(*other.partner_direction, -50 * kDegrees);
    dataset.sequences.push_back(other);
  }
  const auto regression = FitPartnerDirection(dataset, AllOf(dataset));
  ASSERT_TRUE(regression.has_value());
  std::vector<float> first(static_cast<std::size_t>(dataset.class_count()), 0), third = first;
  first[0] = third[2] = 1;
  const motion::Clip leader = Pair(20, 0).pair.leader;
  EXPECT_LT(DegreesOff(*regression, leader, ahead, first), 15);
  EXPECT_LT(DegreesOff(*regression, leader, aside, third), 15);
}

TEST(FitPartnerDirection, DirectionIsThatOfTheSetup) {
  dataset::Dataset dataset = Reachers();
  const motion::Vec3 aside = motion::RotateY({0, 0, -1}, 40 * kDegrees);
  for (dataset::Sequence& sequence : dataset.sequences) {
    sequence = Pair(0, 0);
    sequence.partner_direction = aside;
  }
  // Mirrored leaders reach to the other side with the other hand.
  const auto regression = FitPartnerDirection(dataset, AllOf(dataset));
  ASSERT_TRUE(regression.has_value());
  EXPECT_LT(DegreesOff(*regression, Pair(0, 0).pair.leader, aside), 10);
}

TEST(FitPartnerDirection, ReturnsNothingWithoutHipsOrADirectionOfTheSetup) {
  dataset::Dataset dataset = Reachers();
  for (dataset::Sequence& sequence : dataset.sequences) sequence.partner_direction.reset();
  EXPECT_FALSE(FitPartnerDirection(dataset, AllOf(dataset)).has_value());
  dataset = Reachers();
  EXPECT_FALSE(FitPartnerDirection(dataset, {}).has_value());
  dataset.skeleton.hips.reset();
  EXPECT_FALSE(FitPartnerDirection(dataset, AllOf(dataset)).has_value());
}

}  // namespace
}  // namespace duet::training

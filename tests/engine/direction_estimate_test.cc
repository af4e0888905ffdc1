#include "model/engine/direction_estimate.h"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/support/sample_motion.h"

namespace duet::engine {
namespace {

using ::testing::DoubleNear;
using ::testing::Pointwise;

constexpr int kTorso = 2, kLeftHip = 9, kRightHip = 12, kRightHand = 8;
// Where the features of the right hand begin: the root, before it, has none.
constexpr std::size_t kHandFeature = 2 * (kRightHand - 1);

// A person about a root at `root`, facing -z, whose right hand is held `aside` to the right.
motion::Poses Standing(int frames, motion::Vec3 root, float aside) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  motion::Poses poses(frames, skeleton.joint_count());
  for (motion::Vec3& p : poses.all()) p = root;
  for (int t = 0; t < frames; ++t) {
    poses.at(t, kLeftHip) += motion::Vec3{-0.1f, -0.2f, 0};
    poses.at(t, kRightHip) += motion::Vec3{0.1f, -0.2f, 0};
    poses.at(t, kRightHand) += motion::Vec3{aside, 0.3f, 0};
  }
  return poses;
}

const std::size_t kFeatures =
    static_cast<std::size_t>(DirectionFeatureCount(motion::SbuSkeleton()));

void SetStraightAhead(AngleRegression* regression) {
  regression->mean.assign(kFeatures, 0);
  regression->deviation.assign(kFeatures, 1);
  regression->cosine.assign(kFeatures, 0);
  regression->sine.assign(kFeatures, 0);
  regression->cosine.back() = 1;
}

// The partner is straight ahead of hips, and by `per_metre` of sine to a side for each metre that
// the right hand is held there.
DirectionRegression FollowTheHand(double per_metre) {
  DirectionRegression regression;
  SetStraightAhead(&regression);
  regression.sine[kHandFeature] = per_metre;
  return regression;
}

// Two classes: the first adds nothing, the second `per_metre` of sine for each metre that the hand
// is to the right of the estimate.
DirectionRegression SecondClassFollowsTheHand(double per_metre) {
  DirectionRegression regression = FollowTheHand(0);
  DirectionCorrection& correction = regression.correction.emplace();
  SetStraightAhead(&correction);
  const ClassCoefficients nothing = {std::vector<double>(kFeatures, 0),
                                     std::vector<double>(kFeatures, 0)};
  correction.classes = {nothing, nothing};
  correction.classes[1].sine[kHandFeature] = per_metre;
  return regression;
}

void ExpectNear(std::optional<motion::Vec3> got, motion::Vec3 wanted) {
  ASSERT_TRUE(got.has_value());
  EXPECT_LT(Distance(*got, wanted), 1e-5f) << got->x << " " << got->y << " " << got->z;
}

TEST(DirectionFeatures, AreMeanPlacesAndTheRootsPath) {
  motion::Poses leader = Standing(2, {1, 1, 2}, 0.4f);
  for (motion::Vec3& p : leader[1]) p += motion::Vec3{0.5f, 0.1f, -1};  // one step
  leader.at(1, kRightHand) += motion::Vec3{0.2f, 0, 0.6f};
  const auto features = DirectionFeatures(motion::SbuSkeleton(), leader);
  ASSERT_TRUE(features.has_value());
  std::vector<double> wanted(33, 0);
  wanted[kHandFeature] = 0.5;
  wanted[kHandFeature + 1] = 0.3;
  wanted[2 * (kLeftHip - 1)] = -0.1;
  wanted[2 * (kRightHip - 1)] = 0.1;
  wanted[28] = 0.25, wanted[29] = -0.5;  // mean root
  wanted[30] = 0.5, wanted[31] = -1;     // last root
  wanted[32] = 1;
  EXPECT_THAT(*features, Pointwise(DoubleNear(1e-5), wanted));
}

TEST(EstimatePartnerDirection, FollowsTheHandToItsSide) {
  const auto estimate = [](float aside) {
    return EstimatePartnerDirection(FollowTheHand(2), motion::SbuSkeleton(),
                                    Standing(3, {3, 1, -2}, aside));
  };
  const float side = std::sqrt(0.5f);
  ExpectNear(estimate(0), {0, 0, -1});
  ExpectNear(estimate(0.5f), {side, 0, -side});
  ExpectNear(estimate(-0.5f), {-side, 0, -side});
}

TEST(EstimatePartnerDirection, TurnsWithTheLeader) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  DirectionRegression regression = FollowTheHand(0.7);
  for (std::size_t i = 0; i < regression.sine.size(); ++i) {
    regression.sine[i] += 0.3 * std::sin(static_cast<double>(i));
    regression.cosine[i] += 0.3 * std::cos(static_cast<double>(i));
  }
  const motion::Poses leader = test::SwayingMotion(20, 15);
  const auto straight = EstimatePartnerDirection(regression, skeleton, leader);
  ASSERT_TRUE(straight.has_value());
  for (const double yaw : {0.4, 1.9, 3.1, -2.2}) {
    motion::Poses turned = leader;
    for (motion::Vec3& p : turned.all()) p = RotateY(p, yaw) + motion::Vec3{4, 0, -3};
    ExpectNear(EstimatePartnerDirection(regression, skeleton, turned), RotateY(*straight, yaw));
  }
}

TEST(ClassShares, AreMeansOfWeightsAboveZero) {
  EXPECT_THAT(ClassShares({0.5f, -1, 1.0f, -1}, 2), Pointwise(DoubleNear(1e-6), {0.75, 0.0}));
  EXPECT_THAT(ClassShares({1, 1}, 2), Pointwise(DoubleNear(1e-6), {0.5, 0.5}));
  EXPECT_THAT(ClassShares({2, 0}, 2), Pointwise(DoubleNear(1e-6), {1.0, 0.0}));
  EXPECT_THAT(ClassShares({0, 0}, 2), Pointwise(DoubleNear(1e-6), {0.0, 0.0}));
  EXPECT_THAT(ClassShares({}, 2), Pointwise(DoubleNear(1e-6), {0.0, 0.0}));
}

TEST(EstimatePartnerDirection, CorrectionsAreRelativeToTheEstimate) {
  const motion::Poses leader = Standing(3, {0, 1, 0}, 0.5f);
  DirectionRegression regression = SecondClassFollowsTheHand(0);
  regression.correction->sine[kHandFeature] = 0.4;
  // The hand is at x = .5 before the first correction, at .5 cos of the angle before the second.
  const double first = std::atan2(0.2, 1);
  const double angle = first + std::atan2(0.2 * std::cos(first), 1);
  ExpectNear(EstimatePartnerDirection(regression, motion::SbuSkeleton(), leader),
             {static_cast<float>(std::sin(angle)), 0, static_cast<float>(-std::cos(angle))});
}

TEST(EstimatePartnerDirection, CorrectsByTheClassesThatAreAskedFor) {
  const motion::Poses leader = Standing(3, {0, 1, 0}, 0.5f);
  const DirectionRegression regression = SecondClassFollowsTheHand(1);
  const auto aside = [&](const std::vector<float>& label) {
    return EstimatePartnerDirection(regression, motion::SbuSkeleton(), leader, label)->x;
  };
  EXPECT_NEAR(aside({}), 0, 1e-6);
  EXPECT_NEAR(aside({1, 0}), 0, 1e-6);
  EXPECT_NEAR(aside({1, -1}), 0, 1e-6);
  EXPECT_GT(aside({0, 1}), 0.5f);
  EXPECT_GT(aside({0, 1}), aside({0, 0.5f}));
  EXPECT_FLOAT_EQ(aside({0.5f, 0.5f}), aside({0, 0.5f}));
  EXPECT_FLOAT_EQ(aside({0, 2}), aside({0, 1}));
}

TEST(EstimatePartnerDirection, OneStrangeFeatureCountsAsThreeDeviations) {
  DirectionRegression regression = FollowTheHand(1);
  regression.mean[kHandFeature] = 0.25;
  regression.deviation[kHandFeature] = 0.25;
  const auto estimate = [&](float aside) {
    return EstimatePartnerDirection(regression, motion::SbuSkeleton(),
                                    Standing(3, {0, 1, 0}, aside));
  };
  const float length = std::sqrt(10.0f);
  ExpectNear(estimate(1), {3 / length, 0, -1 / length});
  ExpectNear(estimate(50), {3 / length, 0, -1 / length});
  ExpectNear(estimate(-50), {-3 / length, 0, -1 / length});
}

TEST(EstimatePartnerDirection, HipsWithoutADirectionTellNothing) {
  motion::Poses leader = Standing(3, {0, 1, 0}, 0.5f);
  motion::Skeleton skeleton = motion::SbuSkeleton();
  skeleton.hips.reset();
  EXPECT_FALSE(EstimatePartnerDirection(FollowTheHand(1), skeleton, leader).has_value());
  leader.at(0, kLeftHip) = leader.at(0, kRightHip) = leader.at(0, kTorso);
  EXPECT_FALSE(
      EstimatePartnerDirection(FollowTheHand(1), motion::SbuSkeleton(), leader).has_value());
}

}  // namespace
}  // namespace duet::engine

#include "client/batch/quality.h"

#include <algorithm>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/classifier/random_classifier.h"
#include "tests/support/matchers.h"
#include "tests/support/sample_motion.h"

namespace duet::client::batch {
namespace {

constexpr int kFrames = 30;

// A person, and the same one moved.
motion::ClipPair Pair(motion::Vec3 by) {
  motion::ClipPair pair;
  pair.leader.joint_names = motion::SbuSkeleton().joint_names;
  pair.leader.frame_rate_hz = 15;
  pair.leader.poses = test::SwayingMotion(kFrames, 15);
  pair.follower = pair.leader;
  for (motion::Vec3& position : pair.follower.poses.all()) position += by;
  return pair;
}

motion::Skeleton WithLandmarks() {
  motion::Skeleton skeleton = motion::SbuSkeleton();
  skeleton.hips = motion::JointPair{skeleton.Find("left_hip"), skeleton.Find("right_hip")};
  skeleton.feet = motion::JointPair{skeleton.Find("left_foot"), skeleton.Find("right_foot")};
  return skeleton;
}

TEST(Measure, MeasuresThePlaceOfTheFollower) {
  const Quality standing = Measure(Pair({3, 0, 4}), WithLandmarks());
  EXPECT_NEAR(standing.distance_metres, 5, 1e-4);
  EXPECT_EQ(standing.penetration_metres, 0);
  EXPECT_GT(standing.range_of_motion_metres, 0);
  EXPECT_LT(*standing.lean_degrees, 45);

  const Quality floating = Measure(Pair({0, 0.5f, 0}), WithLandmarks());
  EXPECT_NEAR(*floating.foot_above_floor_metres - *standing.foot_above_floor_metres, 0.5, 1e-4);
  EXPECT_GT(floating.penetration_metres, 0);
  const Quality sunk = Measure(Pair({3, -0.5f, 0}), WithLandmarks());
  EXPECT_GT(*sunk.foot_below_floor_metres, 0.4);
}

TEST(Recognise, UsesTheRequestedClassInAnyOrderOfJoints) {
  const auto classifier = classifier::Classifier::Create(test::RandomClassifier());
  ASSERT_TRUE(classifier.ok());
  const motion::ClipPair pair = Pair({1, 0, 0});
  Quality kick, hug, none, turned;
  Recognise(*classifier, "kick", pair, &kick);
  Recognise(*classifier, "hug", pair, &hug);
  Recognise(*classifier, "none", pair, &none);
  EXPECT_NEAR(*kick.class_probability + *hug.class_probability, 1, 1e-5);
  EXPECT_EQ(kick.recognised_class, *kick.class_probability > 0.5 ? "kick" : "hug");
  EXPECT_EQ(kick.recognised_class, hug.recognised_class);
  EXPECT_EQ(none.recognised_class, "");
  EXPECT_FALSE(none.class_probability);
  motion::ClipPair reversed = pair;
  for (motion::Clip* clip : {&reversed.leader, &reversed.follower}) {
    std::reverse(clip->joint_names.begin(), clip->joint_names.end());
    for (int t = 0; t < kFrames; ++t) {
      std::reverse(clip->poses[t].begin(), clip->poses[t].end());
    }
  }
  Recognise(*classifier, "kick", reversed, &turned);
  EXPECT_NEAR(*turned.class_probability, *kick.class_probability, 1e-6);
}

TEST(WhyRejected, UsesTheProbabilityOfTheClass) {
  QualityFilter filter;
  filter.min_class_probability = 0.5;
  Quality quality;
  EXPECT_THAT(WhyRejected(filter, quality, std::nullopt), IsEmpty());  // not looked at
  quality.class_probability = 0.5;
  EXPECT_THAT(WhyRejected(filter, quality, std::nullopt), IsEmpty());
  quality.class_probability = 0.25;
  EXPECT_THAT(WhyRejected(filter, quality, std::nullopt),
              ElementsAre("class_probability: expected at least 0.5, got 0.25"));
}

TEST(Measure, OmitsFiguresWithoutTheirJoints) {
  motion::Skeleton skeleton = motion::SbuSkeleton();
  skeleton.hips.reset();
  skeleton.feet.reset();
  const Quality quality = Measure(Pair({1, 0, 0}), skeleton);
  EXPECT_FALSE(quality.lean_degrees.has_value());
  EXPECT_FALSE(quality.foot_above_floor_metres.has_value());
}

Quality Good() {
  Quality quality;
  quality.lean_degrees = 10;
  quality.foot_above_floor_metres = 0.1;
  quality.foot_below_floor_metres = 0.1;
  quality.distance_metres = 1;
  quality.penetration_metres = 0.1;
  quality.range_of_motion_metres = 0.1;
  quality.grade = MotionGrade{0.2, 0.5, 0.25, 0.1, {}};
  return quality;
}

TEST(WhyRejected, EachLimitIsCheckedSeparately) {
  EXPECT_THAT(WhyRejected({}, Good(), 5.0), IsEmpty());
  const auto only = [](auto set) {
    QualityFilter filter;
    set(&filter);
    return WhyRejected(filter, Good(), 5.0);
  };
  EXPECT_THAT(only([](QualityFilter* f) { f->max_lean_degrees = 9; }),
              ElementsAre("lean_degrees: expected at most 9, got 10"));
  EXPECT_THAT(only([](QualityFilter* f) { f->max_lean_degrees = 10; }), IsEmpty());
  EXPECT_THAT(only([](QualityFilter* f) { f->max_foot_above_floor_metres = 0.05; }),
              ElementsAre("foot_above_floor_metres: expected at most 0.05, got 0.1"));
  EXPECT_THAT(only([](QualityFilter* f) { f->max_foot_below_floor_metres = 0.05; }),
              ElementsAre("foot_below_floor_metres: expected at most 0.05, got 0.1"));
  EXPECT_THAT(only([](QualityFilter* f) { f->min_distance_metres = 1.5; }),
              ElementsAre("distance_metres: expected at least 1.5, got 1"));
  EXPECT_THAT(only([](QualityFilter* f) { f->max_distance_metres = 0.5; }),
              ElementsAre("distance_metres: expected at most 0.5, got 1"));
  EXPECT_THAT(only([](QualityFilter* f) { f->max_penetration_metres = 0; }),
              ElementsAre("penetration_metres: expected at most 0, got 0.1"));
  EXPECT_THAT(only([](QualityFilter* f) { f->min_range_of_motion_metres = 0.2; }),
              ElementsAre("range_of_motion_metres: expected at least 0.2, got 0.1"));
  EXPECT_THAT(only([](QualityFilter* f) { f->max_unfamiliarity = 1.5; }),
              ElementsAre("unfamiliarity: expected at most 1.5, got 5"));
  EXPECT_THAT(only([](QualityFilter* f) { f->max_twisted = 0.1; }),
              ElementsAre("twisted: expected at most 0.1, got 0.2"));
  EXPECT_THAT(only([](QualityFilter* f) { f->max_overlapping = 0; }),
              ElementsAre("overlapping: expected at most 0, got 0.1"));
  EXPECT_THAT(only([](QualityFilter* f) { f->max_skating_over_leader = 0.2; }),
              ElementsAre("skating_over_leader: expected at most 0.2, got 0.25"));
  EXPECT_THAT(only([](QualityFilter* f) { f->max_skating_over_leader = 0.25; }), IsEmpty());
}

TEST(WhyRejected, UnknownFiguresPass) {
  QualityFilter filter;
  filter.max_lean_degrees = 1;
  filter.max_unfamiliarity = 1;
  filter.max_twisted = 0;
  filter.max_overlapping = 0;
  filter.max_skating_over_leader = 0;
  Quality quality = Good();
  quality.lean_degrees.reset();
  quality.grade.reset();
  EXPECT_THAT(WhyRejected(filter, quality, std::nullopt), IsEmpty());
}

}  // namespace
}  // namespace duet::client::batch

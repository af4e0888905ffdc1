#include "client/batch/answer.h"

#include <google/protobuf/text_format.h>

#include <cmath>
#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"
#include "tests/support/sample_motion.h"

namespace duet::client::batch {
namespace {

// A person, and the same one moved.
SynthesisResult Pair(motion::Vec3 by) {
  SynthesisResult result;
  result.pair.leader = result.pair.follower = test::SwayingClip(30, 15);
  for (motion::Vec3& position : result.pair.follower.poses.all()) position += by;
  return result;
}

motion::Skeleton WithLandmarks() {
  motion::Skeleton skeleton = motion::SbuSkeleton();
  skeleton.hips = motion::JointPair{skeleton.Find("left_hip"), skeleton.Find("right_hip")};
  skeleton.feet = motion::JointPair{skeleton.Find("left_foot"), skeleton.Find("right_foot")};
  return skeleton;
}

double FigureOf(const Quality& quality, const std::string& name) {
  const auto found = quality.figures.find(name);
  return found == quality.figures.end() ? std::nan("") : found->second;
}

TEST(Measure, MeasuresThePlaceOfTheFollower) {
  const Quality standing = Measure(Pair({3, 0, 4}), WithLandmarks(), std::nullopt);
  EXPECT_NEAR(FigureOf(standing, "distance_metres"), 5, 1e-4);
  EXPECT_EQ(FigureOf(standing, "penetration_metres"), 0);
  EXPECT_GT(FigureOf(standing, "range_of_motion_metres"), 0);
  EXPECT_LT(FigureOf(standing, "lean_degrees"), 45);

  const Quality floating = Measure(Pair({0, 0.5f, 0}), WithLandmarks(), std::nullopt);
  EXPECT_NEAR(
      FigureOf(floating, "foot_above_floor_metres") - FigureOf(standing, "foot_above_floor_metres"),
      0.5, 1e-4);
  EXPECT_GT(FigureOf(floating, "penetration_metres"), 0);
  const Quality sunk = Measure(Pair({3, -0.5f, 0}), WithLandmarks(), std::nullopt);
  EXPECT_GT(FigureOf(sunk, "foot_below_floor_metres"), 0.4);

  motion::Skeleton skeleton = motion::SbuSkeleton();
  skeleton.hips.reset();
  skeleton.feet.reset();
  const Quality unknown = Measure(Pair({1, 0, 0}), skeleton, std::nullopt);
  for (const char* name : {"lean_degrees", "foot_above_floor_metres", "twisted"}) {
    EXPECT_EQ(unknown.figures.count(name), 0u) << name;
  }
}

v1::QualityFilter Filter(const std::string& text) {
  v1::QualityFilter filter;
  EXPECT_TRUE(google::protobuf::TextFormat::ParseFromString(text, &filter)) << text;
  return filter;
}

Quality Good() {
  Quality quality;
  quality.figures = {{"lean_degrees", 10},
                     {"foot_above_floor_metres", 0.1},
                     {"foot_below_floor_metres", 0.1},
                     {"distance_metres", 1},
                     {"penetration_metres", 0.1},
                     {"range_of_motion_metres", 0.1},
                     {"twisted", 0.2},
                     {"skating", 0.5},
                     {"leader_skating", 0.25},
                     {"overlapping", 0.1}};
  quality.unfamiliarity = 5;
  return quality;
}

TEST(WhyRejected, EachLimitIsCheckedSeparately) {
  const struct {
    const char* limit;
    const char* reason;  // empty: none
  } kCases[] = {
      {"", ""},
      {"max_lean_degrees: 9", "lean_degrees: expected at most 9, got 10"},
      {"max_lean_degrees: 10", ""},
      {"max_foot_above_floor_metres: 0.05",
       "foot_above_floor_metres: expected at most 0.05, got 0.1"},
      {"max_foot_below_floor_metres: 0.05",
       "foot_below_floor_metres: expected at most 0.05, got 0.1"},
      {"min_distance_metres: 1.5", "distance_metres: expected at least 1.5, got 1"},
      {"max_distance_metres: 0.5", "distance_metres: expected at most 0.5, got 1"},
      {"max_penetration_metres: 0", "penetration_metres: expected at most 0, got 0.1"},
      {"min_range_of_motion_metres: 0.2", "range_of_motion_metres: expected at least 0.2, got 0.1"},
      {"max_unfamiliarity: 1.5", "unfamiliarity: expected at most 1.5, got 5"},
      {"max_twisted: 0.1", "twisted: expected at most 0.1, got 0.2"},
      {"max_overlapping: 0", "overlapping: expected at most 0, got 0.1"},
      {"max_skating_over_leader: 0.2", "skating_over_leader: expected at most 0.2, got 0.25"},
      {"max_skating_over_leader: 0.25", ""},
  };
  for (const auto& one : kCases) {
    const std::vector<std::string> reasons = WhyRejected(Filter(one.limit), Good());
    if (*one.reason == '\0') {
      EXPECT_THAT(reasons, IsEmpty()) << one.limit;
    } else {
      EXPECT_THAT(reasons, ElementsAre(one.reason)) << one.limit;
    }
  }
  EXPECT_THAT(WhyRejected(Filter("max_lean_degrees: 1 max_unfamiliarity: 1"), Quality()), IsEmpty())
      << "unknown figures";
}

}  // namespace
}  // namespace duet::client::batch

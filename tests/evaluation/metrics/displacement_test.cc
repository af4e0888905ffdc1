#include <gtest/gtest.h>

#include <cmath>

#include "model/evaluation/metrics/scores.h"
#include "model/motion/coordinates.h"

namespace duet::evaluation::metrics {
namespace {

// Two frames of two joints. Frame 0 is off by (3, 4, 0) and (0, 0, 12): norm 13. Frame 1 is exact.
const motion::Poses kTruth(2, {{0, 0, 0}, {1, 1, 1}, {2, 0, 0}, {1, 2, 1}});
const motion::Poses kPredicted(2, {{3, 4, 0}, {1, 1, 13}, {2, 0, 0}, {1, 2, 1}});

TEST(AfdTest, AveragesTheNormOverAllCoordinates) {
  EXPECT_DOUBLE_EQ(Afd(kPredicted, kTruth, MetricUnit::kMetres), 13.0 / 2);
  EXPECT_DOUBLE_EQ(AfdSquared(kPredicted, kTruth, MetricUnit::kMetres), 169.0 / 2);
  EXPECT_DOUBLE_EQ(Afd(kTruth, kTruth, MetricUnit::kMetres), 0);
}

TEST(AfdTest, RawUnitsScaleEachAxis) {
  const motion::Poses truth(1, {{0.3f, 0.4f, 0.5f}});
  const auto off_by = [&](motion::Vec3 d) { return motion::Poses(1, {truth.at(0, 0) + d}); };
  EXPECT_NEAR(Afd(off_by({2.56f, 0, 0}), truth, MetricUnit::kSbuRaw), 1, 1e-6);
  EXPECT_NEAR(Afd(off_by({0, 1.92f, 0}), truth, MetricUnit::kSbuRaw), 1, 1e-6);
  EXPECT_NEAR(Afd(off_by({0, 0, 1.28f}), truth, MetricUnit::kSbuRaw), 1, 1e-6);
  EXPECT_NEAR(Afd(off_by({2.56f, 3.84f, 2.56f}), truth, MetricUnit::kSbuRaw), 3, 1e-6);
  EXPECT_NEAR(AfdSquared(off_by({2.56f, 3.84f, 2.56f}), truth, MetricUnit::kSbuRaw), 9, 1e-5);
}

// The paper's pipeline: everything in the raw unit, the leader's torso subtracted, one yaw removed.
TEST(AfdTest, RawUnitsEqualThePapersPipeline) {
  const motion::Coordinates raw_coordinates = {motion::LengthUnit::kSbuNormalised,
                                               motion::UpAxis::kYDown};
  const std::vector<motion::Vec3> truth = {{0.4f, 1.2f, 1.7f}, {0.5f, 0.3f, 1.9f}};
  const std::vector<motion::Vec3> predicted = {{0.6f, 1.1f, 1.6f}, {0.1f, 0.35f, 2.2f}};
  const motion::Vec3 torso = {0.2f, 0.4f, 1.1f};
  const double yaw = 0.7;
  double squared = 0;
  for (size_t i = 0; i < truth.size(); ++i) {
    const motion::Vec3 a = RotateY(predicted[i] - torso, yaw), b = RotateY(truth[i] - torso, yaw);
    squared += Dot(a - b, a - b);
  }
  motion::Poses truth_world(2, truth), predicted_world(2, predicted);
  for (motion::Vec3& p : truth_world.all()) p = ToWorld(raw_coordinates, p);
  for (motion::Vec3& p : predicted_world.all()) p = ToWorld(raw_coordinates, p);
  EXPECT_NEAR(Afd(predicted_world, truth_world, MetricUnit::kSbuRaw), std::sqrt(squared), 1e-5);
}

TEST(RootAlignedAfdTest, IgnoresPlacementButNotPose) {
  motion::Poses moved = kTruth;
  for (motion::Vec3& p : moved[0]) p += motion::Vec3{5, 6, 7};
  for (motion::Vec3& p : moved[1]) p += motion::Vec3{-1, 0, 2};
  EXPECT_DOUBLE_EQ(RootAlignedAfd(moved, kTruth, 0, MetricUnit::kMetres), 0);
  moved.at(1, 1) += motion::Vec3{0, 3, 0};
  EXPECT_DOUBLE_EQ(RootAlignedAfd(moved, kTruth, 0, MetricUnit::kMetres), 1.5);
  // Relative to the other joint, the root is what is off.
  EXPECT_DOUBLE_EQ(RootAlignedAfd(moved, kTruth, 1, MetricUnit::kMetres), 1.5);
}

}  // namespace
}  // namespace duet::evaluation::metrics

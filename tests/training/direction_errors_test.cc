#include <gmock/gmock.h>

#include <cmath>

#include "model/training/direction_fit.h"
#include "tests/evaluation/support/made_up_pairs.h"
#include "tests/support/matchers.h"

namespace duet::training {
namespace {

// The leaders of these pairs face their followers exactly.
TEST(DirectionErrors, AreAnglesFromWhereTheFollowerIs) {
  dataset::Dataset dataset = test::MadeUpPairs(4);
  EXPECT_THAT(DirectionErrors(dataset, {0, 3, 5}, std::nullopt), Each(DoubleNear(0, 0.01)));
  dataset.sequences[0].partner_direction = motion::Vec3{0, 0, -2};  // yaw 0: straight ahead
  dataset.sequences[3].partner_direction =
      motion::RotateY({0, 0, -1}, 0.9 * 3 + 30 * M_PI / 180);  // 30 degrees off the hips
  dataset.sequences[5].partner_direction = motion::RotateY({0, 0, -1}, 0.9 * 1 - 170 * M_PI / 180);
  EXPECT_THAT(DirectionErrors(dataset, {0, 3, 5}, std::nullopt),
              Pointwise(DoubleNear(0.01), {0.0, 30.0, 170.0}));
}

TEST(DirectionErrors, UseTheRegressionIfThereIsOne) {
  const dataset::Dataset dataset = test::MadeUpPairs(4);
  const auto count = static_cast<std::size_t>(engine::DirectionFeatureCount(dataset.skeleton));
  engine::DirectionRegression aside;
  aside.mean.assign(count, 0);
  aside.deviation.assign(count, 1);
  aside.cosine = aside.sine = aside.mean;
  aside.sine.back() = 1;
  EXPECT_THAT(DirectionErrors(dataset, {1, 2}, aside), Each(DoubleNear(90, 0.01)));
  EXPECT_THAT(DirectionErrors(dataset, {}, aside), IsEmpty());
}

}  // namespace
}  // namespace duet::training

#include "model/evaluation/experiments/tilted_answers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "model/base/angle.h"
#include "model/motion/skeleton.h"
#include "tests/evaluation/support/made_up_pairs.h"
#include "tests/support/fake_synthesizer.h"
#include "tests/support/matchers.h"
#include "tests/support/sample_motion.h"

namespace duet::evaluation::experiments {
namespace {

// The followers are the leaders, lifted by 1 m: what Lifter answers to a level leader.
motion::Vec3 Lift(motion::Vec3 leader, absl::Span<const float>) {
  return leader + motion::Vec3{0, 1, 0};
}

// Two sequences of one set, of people who show where the vertical is.
dataset::Dataset LiftedPairs() {
  dataset::Dataset dataset = test::MadeUpPairs(1);
  dataset.skeleton = motion::SbuSkeleton();
  dataset.sequences.resize(2);
  for (dataset::Sequence& sequence : dataset.sequences) {
    sequence.set = "one";
    sequence.pair.leader = {motion::SbuSkeleton().joint_names, 15, test::TurningMotion(15)};
    sequence.pair.follower = sequence.pair.leader;
    for (motion::Vec3& p : sequence.pair.follower.poses.all()) p = Lift(p, {});
    sequence.levelling = motion::Levelling({0, 1, 0.1f}, 0);
    sequence.partner_direction = motion::Vec3{1, 0, 0};
  }
  return dataset;
}

TEST(TiltedAnswersTest, TiltCostsWhatTheVerticalSaves) {
  const dataset::Dataset dataset = LiftedPairs();
  test::FakeSynthesizer model([&] {
    engine::ModelDescription description = test::FakeDescription();
    description.classes = dataset.classes;
    return description;
  }());
  model.answer = Lift;
  const auto rows = AnswerTilted(model, dataset, {0, 1}, StartGiven::kNone, {1, 0, 0}, {10, 90});
  ASSERT_THAT(rows, IsOk());
  ASSERT_EQ(rows->size(), 6u);
  const auto& [never, sent, file, set, exact, harmless] =
      std::tie((*rows)[0], (*rows)[1], (*rows)[2], (*rows)[3], (*rows)[4], (*rows)[5]);
  EXPECT_NEAR(never.error_metres, 0, 1e-4);
  EXPECT_EQ(never.levelled_share, 0);
  // All 15 joints are lifted 10 degrees off the vertical.
  const double off = 2 * std::sin(5 * base::kRadiansPerDegree) * std::sqrt(15);
  EXPECT_NEAR(sent.error_metres, off, 1e-3);
  EXPECT_NEAR(sent.residual_degrees, 10, 0.1);
  for (const TiltedFigures& row : {file, set}) {
    EXPECT_EQ(row.levelled_share, 1) << row.name;
    EXPECT_LT(row.residual_degrees, 1.5) << row.name;
    EXPECT_LT(row.error_metres, 0.15 * off) << row.name;
  }
  EXPECT_NEAR(exact.error_metres, 0, 1e-3);
  EXPECT_NEAR(exact.residual_degrees, 0, 0.05);
  EXPECT_EQ(harmless.levelled_share, 0);
}

TEST(TiltedAnswersTest, TheTiltOfTheCaptureIsItsOwn) {
  const dataset::Dataset dataset = LiftedPairs();
  test::FakeSynthesizer model([&] {
    engine::ModelDescription description = test::FakeDescription();
    description.classes = dataset.classes;
    return description;
  }());
  const auto rows =
      AnswerTilted(model, dataset, {0}, StartGiven::kNone, {1, 0, 0}, {0, std::nullopt});
  ASSERT_THAT(rows, IsOk());
  EXPECT_NEAR((*rows)[1].residual_degrees, std::atan(0.1) * base::kDegreesPerRadian, 0.05);
}

}  // namespace
}  // namespace duet::evaluation::experiments

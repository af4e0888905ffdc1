#include "model/solver/body_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "model/motion/limb_lengths.h"
#include "tests/solver/noisy_person.h"
#include "tests/support/matchers.h"

namespace duet::solver {
namespace {

using motion::Poses;

const motion::Skeleton& Sbu() {
  static const auto* const kSkeleton = new motion::Skeleton(motion::SbuSkeleton());
  return *kSkeleton;
}

BodyModel Measured(const Poses& person) {
  absl::StatusOr<BodyModel> body = BodyModel::Measure(Sbu(), person);
  EXPECT_TRUE(body.ok()) << body.status();
  return *std::move(body);
}

Poses Fitted(Poses person) {
  const BodyModel body = Measured(person);
  for (int t = 0; t < person.frame_count(); ++t) body.Fit(person[t]);
  return person;
}

TEST(BodyModelTest, BonesAndGirdlesOfANoisyCaptureBecomeConstant) {
  const Poses noisy = WithCameraNoise(WalkingPerson(4));
  EXPECT_GT(BodyModel::BoneNoise(Sbu(), noisy), 0.01);
  const Poses fitted = Fitted(noisy);
  EXPECT_LT(BodyModel::BoneNoise(Sbu(), fitted), 1e-5);
  for (const motion::JointPair& pair :
       {*Sbu().hips,
        motion::JointPair{Sbu().Find("left_shoulder"), Sbu().Find("right_shoulder")}}) {
    const float width = Distance(fitted.at(0, pair.left), fitted.at(0, pair.right));
    for (int t = 1; t < fitted.frame_count(); ++t) {
      EXPECT_NEAR(Distance(fitted.at(t, pair.left), fitted.at(t, pair.right)), width, 1e-5) << t;
    }
  }
}

TEST(BodyModelTest, NamesWhatASkeletonLacks) {
  const Poses person = WalkingPerson(1);
  motion::Skeleton without_hips = Sbu();
  without_hips.hips.reset();
  EXPECT_THAT(BodyModel::Measure(without_hips, person),
              test::StatusIs(absl::StatusCode::kInvalidArgument,
                             ::testing::HasSubstr("skeleton: expected hips")));
  motion::Skeleton without_feet = Sbu();
  without_feet.feet.reset();
  EXPECT_THAT(BodyModel::Measure(without_feet, person),
              test::StatusIs(absl::StatusCode::kInvalidArgument, ::testing::HasSubstr("feet")));
  EXPECT_THAT(BodyModel::Measure(Sbu(), Poses(0, 15)),
              test::StatusIs(absl::StatusCode::kInvalidArgument,
                             ::testing::HasSubstr("frames: expected at least 1")));
}

}  // namespace
}  // namespace duet::solver

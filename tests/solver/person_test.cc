#include "model/solver/person.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "model/dataset/dataset.h"
#include "model/solver/body_model.h"
#include "tests/solver/noisy_person.h"
#include "tests/support/data_folder.h"
#include "tests/support/matchers.h"

namespace duet::solver {
namespace {

using motion::Poses;

Poses Solved(const Poses& person) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  absl::StatusOr<Poses> solved =
      SolvePerson(skeleton, person, kRate, StandingHeight(skeleton, person));
  EXPECT_TRUE(solved.ok()) << solved.status();
  return *std::move(solved);
}

TEST(SolvePersonTest, ANoisyPersonGetsABody) {
  const Poses noisy = WithCameraNoise(WalkingPerson(6));
  const Poses solved = Solved(noisy);
  EXPECT_LT(BodyModel::BoneNoise(motion::SbuSkeleton(), solved), 0.001);
  EXPECT_LT(SlowerFoot(solved), SlowerFoot(noisy) / 5);
  EXPECT_NEAR(KneeDegrees(solved), KneeDegrees(noisy), 5);
}

TEST(SolvePersonTest, TheBodyIsNearerToThePersonThanTheCapture) {
  const Poses person = WalkingPerson(6);
  const Poses noisy = WithCameraNoise(person);
  EXPECT_LT(MeanDistance(Solved(noisy), person), MeanDistance(noisy, person));
}

TEST(SolvePersonTest, APersonWithABodyMovesLittle) {
  const Poses person = WalkingPerson(6);
  const Poses solved = Solved(person);
  EXPECT_LT(MeanDistance(solved, person), 0.02);
  EXPECT_NEAR(KneeDegrees(solved), KneeDegrees(person), 2);
}

TEST(SolvePersonTest, FeetStandOnTheFloorThatIsAskedFor) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  const Poses person = WalkingPerson(4);
  const float floor = static_cast<float>(StandingHeight(skeleton, person)) + 0.2f;
  const absl::StatusOr<Poses> solved = SolvePerson(skeleton, person, kRate, floor);
  ASSERT_TRUE(solved.ok()) << solved.status();
  EXPECT_NEAR(StandingHeight(skeleton, *solved), floor, 0.01);
}

TEST(SolvePersonTest, PeopleOfADepthCameraGetBodiesAndKeepTheirKnees) {
  const auto folder = test::FindData("sbu");
  if (!folder) GTEST_SKIP() << test::kNoData;
  const absl::StatusOr<dataset::Dataset> captures = dataset::ReadDataset(*folder);
  ASSERT_TRUE(captures.ok()) << captures.status();
  double knees_before = 0, knees = 0, foot_before = 0, foot = 0, moved = 0;
  for (const dataset::Sequence& sequence : captures->sequences) {
    const Poses& person = sequence.pair.follower.poses;
    const Poses solved = Solved(person);
    knees_before += KneeDegrees(person);
    knees += KneeDegrees(solved);
    foot_before += SlowerFoot(person);
    foot += SlowerFoot(solved);
    moved += MeanDistance(person, solved);
  }
  const auto people = static_cast<double>(captures->sequences.size());
  EXPECT_LT((knees - knees_before) / people, 6);
  EXPECT_LT(foot, foot_before / 4);
  EXPECT_LT(moved / people, 0.05);
}

}  // namespace
}  // namespace duet::solver

#include "model/evaluation/experiments/told_apart.h"

#include <gtest/gtest.h>

#include "tests/evaluation/support/made_up_pairs.h"

namespace duet::evaluation::experiments {
namespace {

using test::MadeUpPairs;

judge::MotionClassifierOptions Small() {
  judge::MotionClassifierOptions options = ToldApartOptions(1);
  options.hidden = 12;
  options.epochs = 12;
  return options;
}

// Answers to the sequences of subject "c", or of all others: the captured follower, made another.
template <typename Change>
std::vector<metrics::ScoredMotion> Answers(const dataset::Dataset& dataset, bool of_c,
                                           Change change) {
  std::vector<int> chosen;
  for (size_t i = 0; i < dataset.sequences.size(); ++i) {
    if ((dataset.sequences[i].subjects.front() == "c") == of_c) {
      chosen.push_back(static_cast<int>(i));
    }
  }
  std::vector<metrics::ScoredMotion> answers = metrics::CapturedMotions(dataset, chosen);
  for (metrics::ScoredMotion& answer : answers) change(&answer.follower);
  return answers;
}

TEST(ToldApartTest, StillFollowersAreDistinguished) {
  const dataset::Dataset dataset = MadeUpPairs(12);
  const auto freeze = [](motion::Poses* poses) {
    for (int t = 1; t < poses->frame_count(); ++t) {
      for (int j = 0; j < poses->joint_count(); ++j) poses->at(t, j) = poses->at(0, j);
    }
  };
  const absl::StatusOr<double> told =
      ToldApart(dataset, Answers(dataset, false, freeze), Answers(dataset, true, freeze), Small());
  ASSERT_TRUE(told.ok()) << told.status();
  EXPECT_GE(*told, 0.85);
}

TEST(ToldApartTest, CapturedFollowersAreIndistinguishable) {
  const dataset::Dataset dataset = MadeUpPairs(12);
  const auto same = [](motion::Poses*) {};
  const absl::StatusOr<double> told =
      ToldApart(dataset, Answers(dataset, false, same), Answers(dataset, true, same), Small());
  ASSERT_TRUE(told.ok()) << told.status();
  EXPECT_EQ(*told, 0.5);  // the same input twice: one of both is wrong
}

TEST(ToldApartTest, NoiseDoesNotDistinguishAnswers) {
  // Shaking in a rhythm of three frames, of which the filter leaves less than a millimetre.
  const dataset::Dataset dataset = MadeUpPairs(12);
  const auto shake = [](motion::Poses* poses) {
    for (int t = 0; t < poses->frame_count(); ++t) {
      for (motion::Vec3& p : (*poses)[t]) p.x += 0.1f * static_cast<float>(t % 3 - 1);
    }
  };
  const absl::StatusOr<double> told =
      ToldApart(dataset, Answers(dataset, false, shake), Answers(dataset, true, shake), Small());
  ASSERT_TRUE(told.ok()) << told.status();
  EXPECT_LE(*told, 0.7);
}

// A model of the data whose answers are cleaned up.
engine::ModelDescription ModelOf(const dataset::Dataset& dataset) {
  engine::ModelDescription model;
  model.skeleton = dataset.skeleton;
  model.classes = dataset.classes;
  model.frame_rate_hz = dataset.frame_rate_hz;
  model.samples = true;
  return model;
}

TEST(ToldApartTest, FinishedFollowersDifferFromCapturedOnesOnlyByTheStages) {
  const dataset::Dataset dataset = MadeUpPairs(6);
  const auto finished = WithFinishedFollowers(ModelOf(dataset), dataset, StartGiven::kNone);
  ASSERT_TRUE(finished.ok()) << finished.status();
  const dataset::Sequence& before = dataset.sequences[0];
  const dataset::Sequence& after = finished->sequences[0];
  EXPECT_EQ(after.pair.leader.poses.all()[0], before.pair.leader.poses.all()[0]);
  ASSERT_EQ(after.pair.follower.frame_count(), before.pair.follower.frame_count());
  // Limbs have the lengths of the leader's, in every frame.
  const motion::Bone bone = dataset.skeleton.bones[0];
  const auto length = [&](const motion::Clip& clip, int t) {
    return Distance(clip.at(t, bone.parent), clip.at(t, bone.child));
  };
  EXPECT_NEAR(length(after.pair.follower, 0), length(after.pair.follower, 3), 1e-5);
  // With a first pose, that one stays as it is.
  const auto posed = WithFinishedFollowers(ModelOf(dataset), dataset, StartGiven::kPose);
  ASSERT_TRUE(posed.ok()) << posed.status();
  const motion::Poses& pose = posed->sequences[0].pair.follower.poses;
  for (int j = 0; j < pose.joint_count(); ++j) {
    EXPECT_LT(Distance(pose.at(0, j), before.pair.follower.at(0, j)), 1e-4);
  }
}

TEST(ToldApartTest, MissingAnswersAreRejected) {
  const dataset::Dataset dataset = MadeUpPairs(3);
  const auto same = [](motion::Poses*) {};
  const std::vector<metrics::ScoredMotion> answers = Answers(dataset, true, same);
  EXPECT_EQ(ToldApart(dataset, {}, answers, Small()).status().code(),
            absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(ToldApart(dataset, answers, {}, Small()).status().code(),
            absl::StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace duet::evaluation::experiments

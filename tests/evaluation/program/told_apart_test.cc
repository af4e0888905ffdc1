#include <gtest/gtest.h>

#include "model/evaluation/program/experiment.h"
#include "tests/evaluation/support/made_up_pairs.h"

namespace duet::evaluation::program {
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

}  // namespace
}  // namespace duet::evaluation::program

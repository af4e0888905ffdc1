#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "model/evaluation/experiments/answers.h"
#include "tests/evaluation/support/made_up_pairs.h"
#include "tests/support/fake_synthesizer.h"
#include "tests/support/matchers.h"

namespace duet::evaluation::experiments {
namespace {

using test::MadeUpPairs;

// Stands still at a height that is the window's seed, at a distance that is its variety, and to the
// side that its direction points to.
class SeedTeller : public engine::Synthesizer {
 public:
  explicit SeedTeller(const dataset::Dataset& dataset) {
    description_ = test::FakeDescription();
    description_.classes = dataset.classes;
    description_.samples = true;
  }

  const engine::ModelDescription& description() const override { return description_; }
  engine::ModelDescription& description() { return description_; }

  std::vector<engine::WindowResult> Synthesize(
      absl::Span<const engine::SynthesisWindow* const> windows) const override {
    std::vector<engine::WindowResult> results;
    for (const engine::SynthesisWindow* window : windows) {
      motion::Poses follower = window->leader;
      for (motion::Vec3& p : follower.all()) {
        p = {window->partner_direction.value_or(motion::Vec3{}).x,
             static_cast<float>(window->options.sampling.seed), window->options.sampling.variety};
      }
      results.emplace_back(std::move(follower));
    }
    return results;
  }

 private:
  engine::ModelDescription description_;
};

TEST(SampledAnswersTest, EveryAnswerHasASeedOfItsOwn) {
  const dataset::Dataset dataset = MadeUpPairs(3);
  const SeedTeller model(dataset);
  const auto answers = AnswerWithSamples(model, dataset, {4, 1}, StartGiven::kNone, {5, 0.5f, 7});
  ASSERT_TRUE(answers.ok()) << answers.status();
  ASSERT_THAT(*answers, SizeIs(5));
  std::set<float> seeds;
  for (const auto& set : *answers) {
    ASSERT_THAT(set, SizeIs(2));
    EXPECT_EQ(set[0].sequence, 4);
    EXPECT_EQ(set[1].sequence, 1);
    for (const metrics::ScoredMotion& motion : set) {
      EXPECT_EQ(motion.follower.at(0, 0).z, 0.5f);
      seeds.insert(motion.follower.at(0, 0).y);
    }
  }
  EXPECT_THAT(seeds, SizeIs(10));
}

TEST(SampledAnswersTest, SeedOfTheSetChangesEverySeed) {
  const dataset::Dataset dataset = MadeUpPairs(3);
  EXPECT_EQ(SeedOf({2, 1, 7}, dataset, 4, 0), SeedOf({2, 1, 7}, dataset, 4, 0));
  EXPECT_NE(SeedOf({2, 1, 7}, dataset, 4, 0), SeedOf({2, 1, 8}, dataset, 4, 0));
}

TEST(SampledAnswersTest, DirectionIsOmittedOnRequest) {
  dataset::Dataset dataset = MadeUpPairs(1);
  dataset.sequences[0].partner_direction = motion::Vec3{1, 0, 0};
  const SeedTeller model(dataset);
  AskedSamples asked = {1, 1, 0};
  const auto told = AnswerWithSamples(model, dataset, {0}, StartGiven::kNone, asked);
  asked.tell_direction = false;
  const auto untold = AnswerWithSamples(model, dataset, {0}, StartGiven::kNone, asked);
  ASSERT_TRUE(told.ok() && untold.ok());
  EXPECT_EQ(told->front().front().follower.at(0, 0).x, 1);
  EXPECT_NE(untold->front().front().follower.at(0, 0).x, 1);
}

TEST(SampledAnswersTest, AModelThatDoesNotSampleAnswersOnce) {
  const dataset::Dataset dataset = MadeUpPairs(1);
  SeedTeller model(dataset);
  model.description().samples = false;
  const auto answers = AnswerWithSamples(model, dataset, {0, 1}, StartGiven::kNone, {});
  ASSERT_TRUE(answers.ok()) << answers.status();
  EXPECT_THAT(*answers, SizeIs(1));
}

TEST(SampledAnswersTest, UnsupportedStartIsRejected) {
  const dataset::Dataset dataset = MadeUpPairs(1);
  SeedTeller model(dataset);
  model.description().accepts_follower_start = false;
  EXPECT_THAT(AnswerWithSamples(model, dataset, {0}, StartGiven::kPose, {}).status(),
              StatusIs(absl::StatusCode::kFailedPrecondition, HasSubstr("follower start")));
}

}  // namespace
}  // namespace duet::evaluation::experiments

#include "gmock/gmock.h"
#include "model/training/finishing.h"
#include "tests/support/matchers.h"
#include "tests/training/made_up_dataset.h"

namespace duet::training {
namespace {

using ::testing::Each;
using ::testing::Lt;
using ::testing::SizeIs;

// A follower that does what the captured one does, as far as its seed says: not at all with 0, more
// with each seed, and exactly as far with 40.
class EverFarther : public engine::Synthesizer {
 public:
  explicit EverFarther(const dataset::Dataset& dataset) : dataset_(dataset) {}
  const engine::ModelDescription& description() const override { return description_; }
  std::vector<engine::WindowResult> Synthesize(
      absl::Span<const engine::SynthesisWindow* const> windows) const override {
    std::vector<engine::WindowResult> answers;
    for (const engine::SynthesisWindow* window : windows) answers.push_back(Answer(*window));
    return answers;
  }

 private:
  engine::WindowResult Answer(const engine::SynthesisWindow& window) const {
    if (broken) return absl::InternalError("not finite");
    const auto& captured =
        std::find_if(dataset_.sequences.begin(), dataset_.sequences.end(), [&](const auto& one) {
          return one.pair.leader.frame_count() == window.leader.frame_count();
        })->pair.follower.poses;
    const float share = static_cast<float>(window.options.sampling.seed) / 40;
    motion::Poses answer = captured;
    for (int t = 0; t < answer.frame_count(); ++t) {
      for (int j = 0; j < answer.joint_count(); ++j) {
        answer.at(t, j) = Lerp(captured.at(0, j), captured.at(t, j), share);
      }
    }
    return answer;
  }

  const dataset::Dataset& dataset_;
  engine::ModelDescription description_;

 public:
  bool broken = false;
};

TEST(DefaultSeeds, AreThoseWhoseFollowersDoAsCapturedOnes) {
  const dataset::Dataset dataset = MadeUpDataset();
  const auto seeds = ChooseDefaultSeeds(EverFarther(dataset), dataset, AllOf(dataset));
  ASSERT_THAT(seeds, IsOk());
  EXPECT_EQ(seeds->front(), 40u);
  EXPECT_THAT(*seeds, SizeIs(16));
  EXPECT_THAT(*seeds, Each(Lt(50u)));
  EXPECT_THAT(*seeds, Each(testing::Gt(30u)));
}

TEST(DefaultSeeds, NeedAnswers) {
  const dataset::Dataset dataset = MadeUpDataset();
  EverFarther synthesizer(dataset);
  synthesizer.broken = true;
  EXPECT_THAT(ChooseDefaultSeeds(synthesizer, dataset, AllOf(dataset)),
              StatusIs(absl::StatusCode::kInternal, testing::HasSubstr("not finite")));
}

}  // namespace
}  // namespace duet::training

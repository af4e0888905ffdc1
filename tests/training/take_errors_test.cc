#include "model/training/take_errors.h"

#include <gmock/gmock.h>

#include <limits>

#include "model/motion/limb_lengths.h"
#include "tests/support/status_matchers.h"
#include "tests/training/flow_test_options.h"
#include "tests/training/made_up_dataset.h"

namespace duet::training {
namespace {

using test::IsOk;
using test::StatusIs;
using ::testing::DoubleNear;
using ::testing::ElementsAre;

constexpr double kRate = 15;
constexpr int kWindow = 30, kPosition = static_cast<int>(kPositionSeconds * kRate);

// A take whose follower stands where its leader does.
dataset::Sequence TakeOf(int frames) {
  dataset::Sequence take = MadeUpDataset(1).sequences[0];
  take.pair.leader.poses = SwayingMotion(frames, kRate);
  take.pair.follower.poses = take.pair.leader.poses;
  take.labels = {{0, 0, kPosition}, {1, kPosition, frames}};
  return take;
}

class TakeErrorsTest : public ::testing::Test {
 protected:
  TakeErrorsTest() { manifest_.model.window_frames = kWindow; }

  absl::StatusOr<std::vector<double>> Measure(const std::vector<dataset::Sequence>& takes,
                                              const AnswerWindows& answer) {
    return ErrorByPosition(manifest_, takes, answer);
  }

  checkpoint::Manifest manifest_ = ManifestFor(SmallFlowOptions(), MadeUpDataset());
};

// Answers with the leader's own motion, moved `aside` metres where class 1 is asked for.
AnswerWindows Mirror(float aside) {
  return [aside](absl::Span<const engine::NetworkInput> inputs) {
    std::vector<motion::Poses> answers;
    for (const engine::NetworkInput& input : inputs) {
      EXPECT_EQ(input.sampling.variety, 0);
      motion::Poses answer = input.leader;
      const std::size_t classes =
          input.labels.size() / static_cast<std::size_t>(answer.frame_count());
      for (int t = input.settled.frame_count(); t < answer.frame_count(); ++t) {
        const float asked = input.labels[static_cast<std::size_t>(t) * classes + 1];
        for (motion::Vec3& joint : answer[t]) joint.x += aside * asked;
      }
      for (int t = 0; t < input.settled.frame_count(); ++t) {
        std::copy(input.settled[t].begin(), input.settled[t].end(), answer[t].begin());
      }
      answers.push_back(std::move(answer));
    }
    return answers;
  };
}

TEST_F(TakeErrorsTest, CountsOnlyWholePositions) {
  EXPECT_EQ(PositionCount({}, kRate), 0);
  EXPECT_EQ(PositionCount({TakeOf(kPosition - 1)}, kRate), 0);
  EXPECT_EQ(PositionCount({TakeOf(kPosition), TakeOf(2 * kPosition + 5)}, kRate), 2);
}

// The pipeline keeps limbs as long as in the first pose, which moves a swaying person a little.
TEST_F(TakeErrorsTest, APerfectAnswerHasNoError) {
  const auto errors = Measure({TakeOf(2 * kPosition)}, Mirror(0));
  ASSERT_THAT(errors, IsOk());
  EXPECT_THAT(*errors, ElementsAre(DoubleNear(0, 0.01), DoubleNear(0, 0.01)));
}

TEST_F(TakeErrorsTest, AnErrorIsReportedWhereTheLabelsMakeIt) {
  const auto errors = Measure({TakeOf(2 * kPosition + 10)}, Mirror(0.2f));
  ASSERT_THAT(errors, IsOk());
  ASSERT_EQ(errors->size(), 2u);
  EXPECT_LT((*errors)[0], 0.01);
  EXPECT_NEAR((*errors)[1], 0.2, 0.01);
}

TEST_F(TakeErrorsTest, APositionIsTheMeanOfTheTakesThatFillIt) {
  dataset::Sequence displaced = TakeOf(kPosition);
  for (motion::Vec3& joint : displaced.pair.follower.poses.all()) joint.x += 0.4f;
  const auto errors = Measure({TakeOf(2 * kPosition), displaced}, Mirror(0));
  ASSERT_THAT(errors, IsOk());
  ASSERT_EQ(errors->size(), 2u);
  EXPECT_GT((*errors)[0], 0.1);
  EXPECT_NEAR((*errors)[1], 0, 0.01);
}

TEST_F(TakeErrorsTest, AnAnswerThatIsNotFiniteIsAnError) {
  EXPECT_THAT(Measure({TakeOf(kPosition)}, Mirror(std::numeric_limits<float>::quiet_NaN())),
              StatusIs(absl::StatusCode::kInternal, ::testing::HasSubstr("not finite")));
}

}  // namespace
}  // namespace duet::training

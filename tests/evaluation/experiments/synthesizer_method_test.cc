#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "model/evaluation/experiments/answers.h"
#include "model/evaluation/protocol/protocol.h"
#include "tests/evaluation/support/made_up_pairs.h"
#include "tests/support/fake_synthesizer.h"
#include "tests/support/matchers.h"

namespace duet::evaluation::experiments {
namespace {

using test::FakeAnswer;
using test::FakeSynthesizer;
using test::MadeUpPairs;

// A leader that takes several windows of the model's.
dataset::Sequence Repeated(const dataset::Sequence& sequence, int times) {
  dataset::Sequence longer = sequence;
  for (int i = 1; i < times; ++i) {
    longer.pair.leader.Append(sequence.pair.leader.poses.all());
  }
  return longer;
}

TEST(SynthesizeSequences, AnswersClipsOfAnyLengthTogether) {
  const dataset::Dataset dataset = MadeUpPairs(2);
  const dataset::Sequence longer =
      Repeated(dataset.sequences[1], 4);  // 68 frames: two windows of 46
  std::vector<size_t> batches;
  FakeSynthesizer model;
  model.on_batch = [&](auto windows) { batches.push_back(windows.size()); };
  const std::vector<const dataset::Sequence*> sequences = {&dataset.sequences[0], &longer,
                                                           &dataset.sequences[0]};
  const std::vector<std::vector<float>> labels = {
      {1, 0, 0, 0, 0, 0}, {0, 0.5f, 0, 0, 0, 0}, {0, 0, 0, 0, 0, -1}};
  std::vector<LabelledLeader> leaders;
  for (size_t i = 0; i < labels.size(); ++i) {
    leaders.push_back({sequences[i], engine::LabelTrack(labels[i])});
  }
  const auto followers = SynthesizeSequences(model, leaders, StartGiven::kNone);
  ASSERT_TRUE(followers.ok()) << followers.status();
  EXPECT_THAT(batches, ElementsAre(3, 1));
  ASSERT_THAT(*followers, SizeIs(3));
  for (size_t i = 0; i < leaders.size(); ++i) {
    const motion::Poses leader = leaders[i].sequence->pair.leader.poses;
    const motion::Poses& follower = (*followers)[i];
    ASSERT_EQ(follower.frame_count(), leader.frame_count());
    ASSERT_EQ(follower.joint_count(), leader.joint_count());
    for (size_t p = 0; p < leader.all().size(); ++p) {
      const motion::Vec3 wanted = FakeAnswer(leader.all()[p], labels[i]);
      ASSERT_NEAR(Norm(follower.all()[p] - wanted), 0, 1e-4) << i << ", " << p;
    }
  }
}

TEST(SynthesizeSequences, PassesAFailureOn) {
  const dataset::Dataset dataset = MadeUpPairs(2);
  FakeSynthesizer model;
  model.window_status = [](const engine::SynthesisWindow& window) {
    return window.labels[1] > 0 ? absl::InternalError("no") : absl::OkStatus();
  };
  const auto labels = [](float first, float second) {
    return engine::LabelTrack(std::vector<float>{first, second, 0, 0, 0, 0});
  };
  const std::vector<LabelledLeader> leaders = {{&dataset.sequences[0], labels(1, 0)},
                                               {&dataset.sequences[0], labels(0, 1)}};
  EXPECT_TRUE(absl::IsInternal(SynthesizeSequences(model, leaders, StartGiven::kNone).status()));
  EXPECT_TRUE(SynthesizeSequences(model, {leaders.data(), 1}, StartGiven::kNone).ok());
}

// A fold says what failed and on which sequence, instead of that an answer is empty.
TEST(SynthesizerMethodTest, AFoldReportsTheFailureOfTheNetwork) {
  const dataset::Dataset dataset = MadeUpPairs(3);
  engine::ModelDescription description;
  description.skeleton = dataset.skeleton;
  description.classes = dataset.classes;
  description.frame_rate_hz = dataset.frame_rate_hz;
  description.window_frames = dataset.LongestFrameCount();
  const auto model = std::make_shared<FakeSynthesizer>(description);
  model->window_status = [](const engine::SynthesisWindow& window) {
    return window.labels[1] > 0 ? absl::ResourceExhaustedError("no memory") : absl::OkStatus();
  };
  SynthesizerMethod method("ours", model, StartGiven::kNone);
  EXPECT_THAT(RunFold(dataset, {{1, 2}, {0, 3}}, &method),
              StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("ours: 1/0: no memory")));
  EXPECT_TRUE(RunFold(dataset, {{1, 2}, {0}}, &method).ok());
}

}  // namespace
}  // namespace duet::evaluation::experiments

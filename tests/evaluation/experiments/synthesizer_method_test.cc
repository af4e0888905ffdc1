#include "model/evaluation/experiments/synthesizer_method.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/evaluation/support/made_up_pairs.h"
#include "tests/support/fake_synthesizer.h"

namespace duet::evaluation::experiments {
namespace {

using test::FakeAnswer;
using test::FakeSynthesizer;
using test::MadeUpPairs;

using ::testing::ElementsAre;
using ::testing::SizeIs;

// A leader that takes several windows of the model's.
dataset::Sequence Repeated(const dataset::Sequence& sequence, int times) {
  dataset::Sequence longer = sequence;
  for (int i = 1; i < times; ++i) {
    const std::vector<motion::Vec3>& once = sequence.pair.leader.positions;
    longer.pair.leader.positions.insert(longer.pair.leader.positions.end(), once.begin(),
                                        once.end());
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
  const std::vector<LabelledLeader> leaders = {{&dataset.sequences[0], {1, 0, 0, 0, 0, 0}},
                                               {&longer, {0, 0.5f, 0, 0, 0, 0}},
                                               {&dataset.sequences[0], {0, 0, 0, 0, 0, -1}}};
  const auto followers = SynthesizeSequences(model, leaders, StartGiven::kNone);
  ASSERT_TRUE(followers.ok()) << followers.status();
  EXPECT_THAT(batches, ElementsAre(3, 1));
  ASSERT_THAT(*followers, SizeIs(3));
  for (size_t i = 0; i < leaders.size(); ++i) {
    const std::vector<motion::Vec3>& leader = leaders[i].sequence->pair.leader.positions;
    ASSERT_EQ((*followers)[i].size(), leader.size());
    for (size_t p = 0; p < leader.size(); ++p) {
      const motion::Vec3 wanted = FakeAnswer(leader[p], leaders[i].labels);
      ASSERT_NEAR(Norm((*followers)[i][p] - wanted), 0, 1e-4) << i << ", " << p;
    }
  }
}

TEST(SynthesizeSequences, PassesAFailureOn) {
  const dataset::Dataset dataset = MadeUpPairs(2);
  FakeSynthesizer model;
  model.window_status = [](const engine::SynthesisWindow& window) {
    return window.labels[1] > 0 ? absl::InternalError("no") : absl::OkStatus();
  };
  const std::vector<LabelledLeader> leaders = {{&dataset.sequences[0], {1, 0, 0, 0, 0, 0}},
                                               {&dataset.sequences[0], {0, 1, 0, 0, 0, 0}}};
  EXPECT_TRUE(absl::IsInternal(SynthesizeSequences(model, leaders, StartGiven::kNone).status()));
  EXPECT_TRUE(SynthesizeSequences(model, {leaders.data(), 1}, StartGiven::kNone).ok());
}

}  // namespace
}  // namespace duet::evaluation::experiments

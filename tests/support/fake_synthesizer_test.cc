#include "tests/support/fake_synthesizer.h"

#include "gtest/gtest.h"
#include "tests/support/sample_motion.h"
#include "tests/support/status_matchers.h"

namespace duet::test {
namespace {

using ::testing::HasSubstr;

engine::SynthesisWindow Window(int frames) {
  engine::SynthesisWindow window;
  window.leader = SwayingMotion(frames, 15);
  window.labels.assign(static_cast<std::size_t>(frames) * 6, 0);
  return window;
}

TEST(FakeSynthesizer, AnswersEachFrameByItsRule) {
  const FakeSynthesizer fake;
  engine::SynthesisWindow window = Window(2);
  window.labels[6] = 0.5f;  // the second frame's first class
  const std::vector<engine::WindowResult> results = fake.Synthesize({&window});
  ASSERT_EQ(results.size(), 1u);
  ASSERT_THAT(results[0], IsOk());
  const motion::Vec3 leader = window.leader.at(1, 0);
  EXPECT_EQ(results[0]->at(1, 0),
            (motion::Vec3{0.25f - leader.x, leader.y + 0.5f, -1.5f - leader.z}));
  EXPECT_EQ(results[0]->at(0, 0).y, window.leader.at(0, 0).y);
}

TEST(FakeSynthesizer, FailsOneWindowAlone) {
  FakeSynthesizer fake;
  fake.window_status = [](const engine::SynthesisWindow& window) {
    return window.leader.frame_count() == 3 ? absl::InternalError("three frames")
                                            : absl::OkStatus();
  };
  const engine::SynthesisWindow two = Window(2), three = Window(3);
  const std::vector<engine::WindowResult> results = fake.Synthesize({&two, &three});
  ASSERT_EQ(results.size(), 2u);
  EXPECT_THAT(results[0], IsOk());
  EXPECT_THAT(results[1], StatusIs(absl::StatusCode::kInternal, HasSubstr("three frames")));
}

TEST(FakeSynthesizer, DrawsBySeedAndVarietyAfterSettledFramesWhereItSamples) {
  engine::SynthesisWindow window = Window(3);
  window.options.sampling = {5, 0.5f};
  window.settled = SwayingMotion(1, 15);
  const motion::Vec3 answer = FakeAnswer(window.leader.at(2, 0), std::vector<float>(6));
  EXPECT_EQ(FakeSynthesizer().Synthesize({&window}).front()->at(2, 0), answer);
  const engine::WindowResult drawn =
      FakeSynthesizer(SamplingDescription()).Synthesize({&window}).front();
  EXPECT_EQ(drawn->at(0, 0), window.settled.at(0, 0));
  EXPECT_EQ(drawn->at(2, 0), answer + (motion::Vec3{0.5f * 5 / 997, 0, 0}));
}

TEST(FakeSynthesizer, ReportsEveryBatch) {
  FakeSynthesizer fake;
  std::vector<std::size_t> sizes;
  fake.on_batch = [&](absl::Span<const engine::SynthesisWindow* const> windows) {
    sizes.push_back(windows.size());
  };
  const engine::SynthesisWindow window = Window(2);
  fake.Synthesize({&window, &window});
  fake.Synthesize({&window});
  EXPECT_THAT(sizes, ::testing::ElementsAre(2, 1));
}

TEST(SampleMotion, MovesSmoothlyAndStandsUpright) {
  const motion::Poses motion = SwayingMotion(60, 15);
  for (int t = 1; t < motion.frame_count(); ++t) {
    for (int j = 0; j < motion.joint_count(); ++j) {
      ASSERT_LT(Distance(motion.at(t, j), motion.at(t - 1, j)), 0.1f) << "frame " << t;
    }
  }
  EXPECT_GT(motion.at(0, 0).y, motion.at(0, 2).y);   // head above torso
  EXPECT_LT(motion.at(0, 14).y, motion.at(0, 2).y);  // foot below it
}

}  // namespace
}  // namespace duet::test

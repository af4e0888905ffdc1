#include "model/engine/window_state.h"

#include <vector>

#include "gtest/gtest.h"
#include "model/engine/window_plan.h"
#include "tests/support/fake_synthesizer.h"
#include "tests/support/sample_motion.h"

namespace duet::engine {
namespace {

using test::FakeDescription;
using test::SamplingDescription;
using test::SwayingMotion;

constexpr int kJoints = 15;

// Frames [first, first + count) of one long motion: windows of it agree where they overlap.
motion::Poses Frames(int first, int count) {
  const motion::Poses all = SwayingMotion(first + count, 15);
  motion::Poses frames(0, kJoints);
  frames.Append(all.frames(first, count));
  return frames;
}

ModelDescription WithStart(ModelDescription model, bool accepts_follower_start) {
  model.accepts_follower_start = accepts_follower_start;
  return model;
}

// The window at frame 12, after one window of 20 frames of which 10 were dropped.
SynthesisWindow Continued(const ModelDescription& model) {
  WindowState state(kJoints);
  state.Add(0, Frames(0, 20), CrossFade(model.skeleton));
  state.DropBefore(10);
  SynthesisWindow window;
  ContinueFrom(state, 12, model, &window);
  return window;
}

TEST(WindowStateTest, IsEmptyBeforeTheFirstWindow) {
  const WindowState state(kJoints);
  EXPECT_EQ(state.window_count(), 0);
  EXPECT_EQ(state.begin(), 0);
  EXPECT_EQ(state.end(), 0);
}

TEST(WindowStateTest, AddAppendsTheFramesAfterTheOverlap) {
  const CrossFade cross_fade(FakeDescription().skeleton);
  WindowState state(kJoints);
  state.Add(0, Frames(0, 20), cross_fade);
  EXPECT_EQ(state.end(), 20);
  state.Add(12, Frames(12, 20), cross_fade);
  EXPECT_EQ(state.window_count(), 2);
  EXPECT_EQ(state.begin(), 0);
  EXPECT_EQ(state.end(), 32);
  const motion::Poses expected = Frames(0, 32);
  for (std::size_t i = 0; i < expected.all().size(); ++i) {
    ASSERT_LT(Distance(state.follower().all()[i], expected.all()[i]), 1e-4F) << "position " << i;
  }
}

TEST(WindowStateTest, DropBeforeKeepsFrameNumbers) {
  const CrossFade cross_fade(FakeDescription().skeleton);
  WindowState state(kJoints);
  state.Add(0, Frames(0, 20), cross_fade);
  const motion::Vec3 frame_12 = state.follower().at(12, 0);
  state.DropBefore(12);
  EXPECT_EQ(state.begin(), 12);
  EXPECT_EQ(state.end(), 20);
  EXPECT_EQ(state.follower().at(0, 0), frame_12);
  state.DropBefore(5);
  EXPECT_EQ(state.begin(), 12) << "dropped frames came back";
  state.DropBefore(100);
  EXPECT_EQ(state.begin(), 20) << "frames that do not exist were dropped";
  EXPECT_EQ(state.end(), 20);
}

TEST(WindowStateTest, CopiesAreIndependent) {
  const CrossFade cross_fade(FakeDescription().skeleton);
  WindowState state(kJoints);
  state.Add(0, Frames(0, 20), cross_fade);
  WindowState tried = state;
  tried.Add(12, Frames(12, 20), cross_fade);
  tried.DropBefore(15);
  EXPECT_EQ(state.window_count(), 1);
  EXPECT_EQ(state.begin(), 0);
  EXPECT_EQ(state.follower(), Frames(0, 20));
}

TEST(ContinueFromTest, SetsNothingForAModelWithoutAFollowerStart) {
  const SynthesisWindow window = Continued(WithStart(FakeDescription(), false));
  EXPECT_FALSE(window.start.has_value());
  EXPECT_EQ(window.settled.frame_count(), 0);
}

TEST(ContinueFromTest, SetsOnlyTheStartForAModelThatDoesNotSample) {
  const ModelDescription model = WithStart(FakeDescription(), true);
  const SynthesisWindow window = Continued(model);
  ASSERT_TRUE(window.start.has_value());
  EXPECT_EQ(window.start->root, Frames(0, 20).at(12, model.skeleton.root));
  ASSERT_EQ(window.start->pose.size(), static_cast<std::size_t>(kJoints));
  EXPECT_EQ(window.start->pose[3], Frames(0, 20).at(12, 3));
  EXPECT_EQ(window.settled.frame_count(), 0);
}

TEST(ContinueFromTest, SetsEverySettledFrameForASamplingModel) {
  const SynthesisWindow window = Continued(WithStart(SamplingDescription(), true));
  ASSERT_TRUE(window.start.has_value());
  EXPECT_EQ(window.settled, Frames(12, 8));
}

TEST(WindowStateTest, DroppedLastFramesAreThoseOfTheNextWindow) {
  const ModelDescription model = WithStart(SamplingDescription(), true);
  WindowState state(kJoints);
  state.Add(0, Frames(0, 20), CrossFade(model.skeleton));
  state.DropFrom(14);
  EXPECT_EQ(state.end(), 14);
  state.Add(14, Frames(100, 20), CrossFade(model.skeleton));
  EXPECT_EQ(state.end(), 34);
  EXPECT_EQ(state.follower().at(14, 3), Frames(100, 20).at(0, 3));
  state.DropFrom(-1000);
  EXPECT_EQ(state.end(), state.begin());
}

TEST(WindowOverlapTest, IsThatOfSettledFramesOnlyIfTheModelContinuesFromThem) {
  ModelDescription model = WithStart(SamplingDescription(), true);
  EXPECT_TRUE(ContinuesFromSettledFrames(model));
  EXPECT_EQ(WindowOverlap(model), SettledOverlap(model.window_frames));
  model.lookahead_frames = 9;
  EXPECT_EQ(WindowOverlap(model), SettledOverlap(model.window_frames) + 9);
  model = WithStart(model, false);
  EXPECT_FALSE(ContinuesFromSettledFrames(model));
  EXPECT_EQ(WindowOverlap(model), CrossFadeOverlap(model.window_frames));
}

}  // namespace
}  // namespace duet::engine

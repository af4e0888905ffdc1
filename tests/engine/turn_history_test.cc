#include "model/engine/turn_history.h"

#include <cmath>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "gmock/gmock.h"
#include "model/engine/clip_synthesis.h"
#include "model/engine/window_plan.h"
#include "model/engine/window_state.h"
#include "model/motion/resample.h"
#include "tests/cleanup/bodies.h"
#include "tests/support/fake_synthesizer.h"

namespace duet::engine {
namespace {

using cleanup::Changed;
using cleanup::kRate;
using cleanup::Moved;
using cleanup::Puppet;
using motion::Poses;
using motion::Vec3;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr int kFrames = 150;
constexpr int kTurn = 1;                // class of the turn
constexpr int kBegin = 20, kEnd = 100;  // of its label
constexpr double kPerFrame = 10;        // degrees

ModelDescription Description() {
  ModelDescription description = test::FakeDescription();
  description.frame_rate_hz = kRate;
  description.turning_classes = {{description.classes[kTurn], 240}};
  return description;
}

// The weight is 1 in frames [kBegin, kEnd) and 0 elsewhere.
LabelTrack Labels() {
  const std::vector<float> none(Description().classes.size());
  std::vector<float> turn = none;
  turn[kTurn] = 1;
  return LabelTrack({{kBegin - 1, none}, {kBegin, turn}, {kEnd - 1, turn}, {kEnd, none}});
}

Poses Turning() {
  const auto turned = [](int t, Vec3 joint) {
    return RotateY(joint, kPerFrame * t * 3.14159265 / 180);
  };
  return Moved(Changed(Puppet({}, kFrames), turned), {0, 0, 0.8f});
}

TurnHistory History() { return TurnHistory(Description(), Labels(), kRate, kFrames); }

TEST(TurnHistory, AWindowKnowsHowLongALabelGoesOn) {
  const TurnHistory history = History();
  EXPECT_EQ(history.Around(0, kBegin).after, 0);
  EXPECT_EQ(history.Around(0, kBegin + 1).after, kEnd - kBegin - 1);
  EXPECT_EQ(history.Around(0, kEnd - 1).after, 1);
  EXPECT_EQ(history.Around(0, kEnd).after, 0);
  EXPECT_EQ(history.Around(0, kFrames).after, 0);
}

TEST(TurnHistory, AWindowKnowsHowFarTheFollowerTurnedSinceTheLabelBegan) {
  TurnHistory history = History();
  EXPECT_THAT(history.Around(0, 45).before, IsEmpty());
  const Poses leader = Puppet({}, kFrames);
  history.Add(Description().skeleton, motion::Part(leader, 0, 41), motion::Part(Turning(), 0, 41));
  EXPECT_EQ(history.end(), 41);
  const std::vector<double> before = history.Around(40, 85).before;
  EXPECT_THAT(before, SizeIs(40 - kBegin + 1));
  EXPECT_NEAR(std::abs(std::accumulate(before.begin(), before.end(), 0.0)),
              kPerFrame * (40 - kBegin + 1), 30);
  history.Add(Description().skeleton, motion::Part(leader, 40, 71),
              motion::Part(Turning(), 40, 71));
  EXPECT_EQ(history.end(), 111);
  EXPECT_THAT(history.Around(110, 150).before, IsEmpty());
}

TEST(TurnHistory, ModelsWithoutClassesOfTurnsHaveNone) {
  ModelDescription description = Description();
  description.turning_classes.clear();
  const TurnHistory history(description, Labels(), kRate, kFrames);
  EXPECT_FALSE(history.is_used());
  EXPECT_EQ(history.Around(0, 45).after, 0);
}

TEST(TurnHistory, WindowsOfAClipHaveIt) {
  ModelDescription description = Description();
  description.samples = true;
  ClipRequest request{Puppet({}, kFrames), kRate, Labels(), std::nullopt, std::nullopt, {}, {}};
  ClipSynthesis clip(description, std::move(request));
  const std::vector<int> starts =
      PlanWindows(kFrames, description.window_frames, WindowOverlap(description)).starts;
  ASSERT_GT(starts.size(), 3u);
  for (const int start : starts) {
    const SynthesisWindow window = clip.NextWindow();
    const bool is_labelled = kBegin <= start && start < kEnd;
    const std::vector<double>& before = window.turns_around.before;
    ASSERT_THAT(before, SizeIs(is_labelled ? start - kBegin + 1 : 0));
    EXPECT_NEAR(std::abs(std::accumulate(before.begin(), before.end(), 0.0)),
                kPerFrame * static_cast<double>(before.size()), 30);
    const int frames = window.leader.frame_count();
    EXPECT_EQ(window.turns_around.after,
              start + frames > kBegin && start + frames < kEnd ? kEnd - start - frames : 0);
    clip.Accept(motion::Part(Turning(), start, frames));
  }
}

}  // namespace
}  // namespace duet::engine

#include "model/engine/finished_motions.h"

#include <memory>

#include "gmock/gmock.h"
#include "model/engine/network_synthesizer.h"
#include "model/engine/window_standardisation.h"
#include "tests/engine/rule_network.h"
#include "tests/support/fake_synthesizer.h"
#include "tests/support/matchers.h"
#include "tests/support/sample_motion.h"

namespace duet::engine {
namespace {

using test::FakeDescription;
using test::SwayingMotion;

// A follower that stands beside the leader, turned by some angle, with an arm that grows.
motion::Poses Follower(int frames) {
  motion::Poses follower = SwayingMotion(frames, 15);
  for (int t = 0; t < frames; ++t) {
    for (motion::Vec3& joint : follower[t]) joint += motion::Vec3{0, 0.1f, -1};
    follower.at(t, 8).x += 0.02f * static_cast<float>(t);
  }
  return follower;
}

SynthesisWindow Window(int frames) {
  SynthesisWindow window;
  window.leader = SwayingMotion(frames, 15);
  window.labels.assign(static_cast<std::size_t>(frames) * 6, 0.5f);
  return window;
}

TEST(FinishMotions, PassTheStagesOfAnAnswer) {
  ModelDescription description = FakeDescription();
  description.samples = true;
  const std::vector<SynthesisWindow> windows = {Window(12), Window(20)};
  const std::vector<motion::Poses> followers = {Follower(12), Follower(20)};
  const std::vector<WindowResult> finished = FinishMotions(description, windows, followers);
  ASSERT_EQ(finished.size(), 2u);
  for (std::size_t i = 0; i < finished.size(); ++i) {
    ASSERT_THAT(finished[i], IsOk());
    // The answer of a network that says the same.
    const auto says = [&](Inputs) -> Answer {
      return std::vector<motion::Poses>{
          WindowStandardisation(description.skeleton, windows[i]).Apply(followers[i])};
    };
    const auto model = MakeSynthesizer(description, motion::StandardOrigin::kEveryFrame,
                                       std::make_unique<RuleNetwork>(says));
    const WindowResult answer = model->Synthesize({&windows[i]}).front();
    ASSERT_THAT(answer, IsOk());
    ASSERT_EQ(answer->all().size(), finished[i]->all().size());
    double moved = 0;
    for (std::size_t p = 0; p < answer->all().size(); ++p) {
      EXPECT_LT(Distance(answer->all()[p], finished[i]->all()[p]), 1e-3f);
      moved += double{Distance(finished[i]->all()[p], followers[i].all()[p])};
    }
    EXPECT_GT(moved, 0.1);  // they do change it
  }
}

}  // namespace
}  // namespace duet::engine

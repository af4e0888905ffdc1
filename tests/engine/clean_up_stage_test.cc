#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>

#include "gtest/gtest.h"
#include "model/engine/clip_synthesis.h"
#include "model/engine/network_synthesizer.h"
#include "model/motion/feet.h"
#include "tests/engine/rule_network.h"
#include "tests/support/fake_synthesizer.h"
#include "tests/support/sample_motion.h"

namespace duet::engine {
namespace {

using motion::Vec3;
using test::FakeDescription;
using test::SwayingMotion;
using test::SwayingPose;

constexpr int kNeck = 1, kRoot = 2, kLeftFoot = 11, kRightFoot = 14;
constexpr int kWindow = 46;
constexpr double kDegrees = 3.14159265358979 / 180;

Vec3 Lean(Vec3 joint, Vec3 pivot, double degrees) {
  const float c = static_cast<float>(std::cos(degrees * kDegrees));
  const float s = static_cast<float>(std::sin(degrees * kDegrees));
  const Vec3 p = joint - pivot;
  return pivot + Vec3{p.x, c * p.y - s * p.z, s * p.y + c * p.z};
}

// Goes on from where the follower stands and, until the window's end, leans 3 degrees more, drifts
// 20 cm farther away and floats 5 cm higher: what a network does to a chain of windows.
motion::Poses Topple(const NetworkInput& input) {
  motion::Poses follower = input.settled;
  if (follower.empty()) follower = motion::Poses(0, 15);
  std::vector<Vec3> pose;
  if (!follower.empty()) {
    const absl::Span<const Vec3> last = follower[follower.frame_count() - 1];
    pose.assign(last.begin(), last.end());
  } else if (input.start) {
    pose = input.start->pose;
  } else {
    for (const Vec3& joint : input.leader[0]) pose.push_back(joint + Vec3{0, 0, -1});
  }
  for (int k = 1; follower.frame_count() < input.leader.frame_count(); ++k) {
    const float share = static_cast<float>(k - 1) / kWindow;
    const Vec3 pivot = Lerp(pose[kLeftFoot], pose[kRightFoot], 0.5f);
    std::vector<Vec3> next;
    for (const Vec3& joint : pose) {
      next.push_back(Lean(joint, pivot, -3 * share) + Vec3{0, 0.05f * share, -0.2f * share});
    }
    follower.Append(next);
  }
  return follower;
}

Answer ToppleAll(Inputs inputs) {
  std::vector<motion::Poses> followers;
  for (const NetworkInput& input : inputs) followers.push_back(Topple(input));
  return followers;
}

ModelDescription Sampling(bool samples = true) {
  ModelDescription description = FakeDescription();
  description.samples = samples;
  description.accepts_follower_start = true;
  return description;
}

std::unique_ptr<Synthesizer> Model(const ModelDescription& description) {
  return MakeSynthesizer(description, motion::StandardOrigin::kFirstFrame,
                         std::make_unique<RuleNetwork>(ToppleAll));
}

motion::Poses Chain(const Synthesizer& model, int seconds, bool clean_up = true) {
  ClipRequest request{SwayingMotion(15 * seconds, 15),
                      15,
                      LabelTrack(std::vector<float>(6, 0)),
                      std::nullopt,
                      std::nullopt,
                      {{}, clean_up}};
  ClipSynthesis clip(model.description(), std::move(request));
  motion::Poses follower(0, 15);
  while (clip.HasNextWindow()) {
    const SynthesisWindow window = clip.NextWindow();
    follower.Append(clip.Accept(*model.Synthesize({&window}).front()).all());
  }
  return follower;
}

// The worst of a whole clip.
struct Worst {
  double lean_degrees = 0, feet_off_floor = 0, distance = 0, step = 0;
};

Worst WorstOf(const motion::Poses& follower) {
  const motion::Poses leader = SwayingMotion(follower.frame_count(), 15);
  const float floor = motion::FloorHeight({kLeftFoot, kRightFoot}, leader);
  Worst worst;
  for (int t = 0; t < follower.frame_count(); ++t) {
    const Vec3 left = follower.at(t, kLeftFoot), right = follower.at(t, kRightFoot);
    const Vec3 trunk = follower.at(t, kNeck) - Lerp(left, right, 0.5f);
    const Vec3 apart = follower.at(t, kRoot) - leader.at(t, kRoot);
    worst.lean_degrees = std::max(worst.lean_degrees, std::acos(trunk.y / Norm(trunk)) / kDegrees);
    worst.feet_off_floor =
        std::max<double>(worst.feet_off_floor, std::abs(std::min(left.y, right.y) - floor));
    worst.distance = std::max<double>(worst.distance, std::hypot(apart.x, apart.z));
    for (int j = 0; t > 0 && j < 15; ++j) {
      worst.step = std::max<double>(worst.step, Distance(follower.at(t, j), follower.at(t - 1, j)));
    }
  }
  return worst;
}

TEST(CleanUpStage, AChainOfWindowsStaysUprightOnTheFloorAndNear) {
  const auto model = Model(Sampling());
  for (const int seconds : {60, 600}) {
    const Worst worst = WorstOf(Chain(*model, seconds));
    EXPECT_LT(worst.lean_degrees, 17) << seconds;
    EXPECT_LT(worst.feet_off_floor, 0.08) << seconds;
    EXPECT_LT(worst.distance, 3) << seconds;
    EXPECT_LT(worst.step, 0.15) << seconds;  // metres a frame: a foot steps, nothing pops
  }
}

TEST(CleanUpStage, WithoutItTheSameChainTopples) {
  const Worst worst = WorstOf(Chain(*Model(Sampling()), 60, /*clean_up=*/false));
  EXPECT_GT(worst.lean_degrees, 45);
  EXPECT_GT(worst.feet_off_floor, 0.5);
  EXPECT_GT(worst.distance, 4);
}

SynthesisWindow Leaning() {
  SynthesisWindow window;
  window.leader = SwayingMotion(kWindow, 15);
  window.labels.assign(static_cast<std::size_t>(kWindow) * 6, 0);
  std::vector<Vec3> pose = SwayingPose(0);
  for (Vec3& joint : pose) joint = Lean(joint, {0, 0, 0}, 30) + Vec3{0, 0, -1.5f};
  window.start = FollowerStart{pose[kRoot], pose};
  return window;
}

motion::Poses RunOne(const Synthesizer& model, const SynthesisWindow& window) {
  return *model.Synthesize({&window}).front();
}

TEST(CleanUpStage, DefaultsToModelsThatSample) {
  SynthesisWindow window = Leaning();
  const motion::Poses plain = RunOne(*Model(Sampling(false)), window);
  const motion::Poses cleaned = RunOne(*Model(Sampling()), window);
  EXPECT_NE(cleaned, plain);
  window.options.clean_up = true;
  EXPECT_EQ(RunOne(*Model(Sampling(false)), window), cleaned);
  window.options.clean_up = false;
  EXPECT_EQ(RunOne(*Model(Sampling()), window), plain);
}

TEST(CleanUpStage, WindowsOfABatchHaveTheirOwnChoices) {
  const auto model = Model(Sampling());
  SynthesisWindow told = Leaning(), told_not = Leaning();
  told.options.clean_up = true;
  told_not.options.clean_up = false;
  const motion::Poses cleaned = RunOne(*model, told), plain = RunOne(*model, told_not);
  ASSERT_NE(cleaned, plain);
  const SynthesisWindow unsaid = Leaning();
  const auto batch = model->Synthesize({&told_not, &told, &unsaid, &told_not});
  ASSERT_EQ(batch.size(), 4u);
  EXPECT_EQ(*batch[0], plain);
  EXPECT_EQ(*batch[1], cleaned);
  EXPECT_EQ(*batch[2], cleaned);
  EXPECT_EQ(*batch[3], plain);
}

TEST(CleanUpStage, LeavesTheStartAndTheFramesThatTheCallerHas) {
  SynthesisWindow window = Leaning();
  const auto expect_given = [&](const motion::Poses& given) {
    const motion::Poses cleaned = RunOne(*Model(Sampling()), window);
    for (int t = 0; t < given.frame_count(); ++t) EXPECT_EQ(cleaned[t], given[t]) << t;
  };
  expect_given(motion::Poses(15, window.start->pose));
  window.settled = motion::Poses(0, 15);
  for (int t = 0; t < 12; ++t) window.settled.Append(window.start->pose);
  expect_given(window.settled);
  motion::Poses all = window.settled;
  window.sent = motion::Poses(15, window.start->pose);
  for (Vec3& joint : window.sent.all()) joint.x += 0.01f;
  all.Append(window.sent.all());
  expect_given(all);
}

TEST(ContactRules, BodiesTouchAsFarAsATouchingClasssLabelGoes) {
  ModelDescription description = FakeDescription();
  description.classes = {"kick", "hug"};
  description.touching_classes = {"hug"};
  const std::vector<float> labels = {0.9f, -0.75f, 0.9f, 0.25f, 0.9f, 1.25f};
  const auto overlap = [&](std::size_t t) {
    return ContactRulesOf(description, body::FindBody(description.skeleton), labels)[t].overlap;
  };
  EXPECT_EQ(overlap(0), 0);
  EXPECT_EQ(overlap(1), 0.25f);
  EXPECT_EQ(overlap(2), 1);
  description.touching_classes.clear();
  EXPECT_EQ(overlap(2), 0);
}

TEST(ContactRules, AreMeansByTheWeightsOfTheClasses) {
  ModelDescription description = FakeDescription();
  description.classes = {"shake", "dance", "walk"};
  description.hand_contacts = {{"shake", 0.2}, {"dance", 0.4}};
  description.trunk_contacts = {{"shake", "left_hand", {1, 1, 0}},
                                {"dance", "left_hand", {0, 1, 1}}};
  description.facing_classes = {{"shake", 30}, {"walk", 90}};
  const solver::ContactRules rules =
      ContactRulesOf(description, body::FindBody(description.skeleton),
                     std::vector<float>{1, 0, 0, 0.25f, 0.75f, 0, 0, 0, -1});
  EXPECT_FLOAT_EQ(rules[0].hands_metres, 0.2f);
  EXPECT_FLOAT_EQ(rules[0].away_degrees, 30);
  EXPECT_FLOAT_EQ(rules[1].hands, 1);
  EXPECT_FLOAT_EQ(rules[1].hands_metres, 0.35f);
  EXPECT_FLOAT_EQ(rules[1].away_degrees, 0.25f * 30 + 0.75f * 180);
  EXPECT_FLOAT_EQ(rules[1].holds[0].weight, 1);
  EXPECT_LT(Distance(rules[1].holds[0].place, {0.25f, 1, 0.75f}), 1e-6f);
  EXPECT_EQ(rules[1].holds[1].weight, 0);
  EXPECT_EQ(rules[2].hands, 0);
  EXPECT_EQ(rules[2].away_degrees, 180) << "nothing is asked for";
}

}  // namespace
}  // namespace duet::engine

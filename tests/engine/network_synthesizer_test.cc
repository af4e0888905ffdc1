#include "model/engine/network_synthesizer.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <utility>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/base/angle.h"
#include "model/engine/windows.h"
#include "model/motion/feet.h"
#include "model/motion/limb_lengths.h"
#include "model/solver/partner.h"
#include "tests/engine/rule_network.h"
#include "tests/support/bodies.h"
#include "tests/support/fake_synthesizer.h"
#include "tests/support/sample_motion.h"
#include "tests/support/status_matchers.h"

namespace duet::engine {
namespace {

using test::FakeDescription;
using test::IsOk;
using test::StatusIs;
using test::SwayingMotion;
using test::SwayingPose;

using ::testing::HasSubstr;

std::unique_ptr<Synthesizer> Model(
    std::function<Answer(Inputs)> rule, bool as_served = true,
    ModelDescription description = FakeDescription(),
    motion::StandardOrigin origin = motion::StandardOrigin::kEveryFrame) {
  return MakeSynthesizer(std::move(description), origin,
                         std::make_unique<RuleNetwork>(std::move(rule)), as_served);
}

constexpr bool kAsTheNetworkSays = false;

// The leader, half as large again and half a metre higher.
Answer LargerAndHigher(Inputs inputs) {
  std::vector<motion::Poses> followers;
  for (const NetworkInput& input : inputs) {
    followers.push_back(input.leader);
    for (motion::Vec3& p : followers.back().all()) p = p * 1.5f + motion::Vec3{0, 0.5f, -1};
  }
  return followers;
}

SynthesisWindow Window(int frames = 12) {
  SynthesisWindow window;
  window.leader = SwayingMotion(frames, 15);
  window.labels.assign(static_cast<std::size_t>(frames) * 6, 0.5f);
  return window;
}

WindowResult RunOne(const Synthesizer& model, const SynthesisWindow& window) {
  return model.Synthesize({&window}).front();
}

NetworkInput SeenByTheNetwork(const SynthesisWindow& window, motion::StandardOrigin origin) {
  NetworkInput seen;
  const auto model = Model(
      [&](Inputs inputs) {
        seen = inputs[0];
        return LargerAndHigher(inputs);
      },
      true, FakeDescription(), origin);
  EXPECT_THAT(RunOne(*model, window), IsOk());
  return seen;
}

float LargestDistance(const motion::Poses& a, const motion::Poses& b) {
  EXPECT_EQ(a.all().size(), b.all().size());
  float largest = 0;
  for (std::size_t i = 0; i < a.all().size(); ++i) {
    largest = std::max(largest, Distance(a.all()[i], b.all()[i]));
  }
  return largest;
}

TEST(NetworkSynthesizer, TheNetworkSeesTheStandardFrame) {
  SynthesisWindow window = Window();
  window.partner_direction = motion::Vec3{1, 0, 0};
  window.start = FollowerStart{SwayingPose(3)[2], SwayingPose(3)};
  window.settled = SwayingMotion(4, 15);
  window.options.sampling = {41, 0.25f};
  for (const auto origin :
       {motion::StandardOrigin::kEveryFrame, motion::StandardOrigin::kFirstFrame}) {
    const NetworkInput seen = SeenByTheNetwork(window, origin);
    const motion::Standardisation frame(motion::SbuSkeleton(), window.leader,
                                        motion::FacingYaw({1, 0, 0}), origin);
    EXPECT_EQ(seen.leader, frame.Apply(window.leader));
    EXPECT_EQ(seen.settled, frame.Apply(window.settled));
    EXPECT_EQ(seen.labels, window.labels);
    EXPECT_EQ(seen.start->root, frame.Apply(window.start->root));
    ASSERT_EQ(seen.start->pose.size(), 15u);
    EXPECT_EQ(seen.start->pose[5], frame.Apply(window.start->pose[5]));
    EXPECT_EQ(seen.sampling.seed, 41u);
    EXPECT_EQ(seen.sampling.variety, 0.25f);
  }
}

TEST(NetworkSynthesizer, SettledFramesThatTheNetworkAnswersStay) {
  // The follower has other limbs than the leader, of constant lengths, and another floor.
  SynthesisWindow window = Window();
  window.settled = SwayingMotion(4, 15);
  for (motion::Vec3& p : window.settled.all()) p = p * 1.25f + motion::Vec3{0.5f, 0.25f, -1};
  SetBoneLengths(motion::SbuSkeleton(), MedianBoneLengths(motion::SbuSkeleton(), window.settled),
                 &window.settled);
  window.start =
      FollowerStart{window.settled.at(0, 2), {window.settled[0].begin(), window.settled[0].end()}};
  const auto model = Model([](Inputs inputs) {
    Answer followers = LargerAndHigher(inputs);
    const absl::Span<const motion::Vec3> settled = inputs[0].settled.all();
    std::copy(settled.begin(), settled.end(), followers->front().all().begin());
    return followers;
  });
  const WindowResult result = RunOne(*model, window);
  ASSERT_THAT(result, IsOk());
  motion::Poses first(0, 15);
  first.Append(result->frames(0, 4));
  EXPECT_LT(LargestDistance(first, window.settled), 1e-5f);
}

TEST(NetworkSynthesizer, BringsTheAnswerBackToTheWorld) {
  const auto model =
      Model([](Inputs inputs) { return std::vector<motion::Poses>{inputs[0].leader}; },
            kAsTheNetworkSays);
  const SynthesisWindow window = Window();
  const WindowResult result = RunOne(*model, window);
  ASSERT_THAT(result, IsOk());
  EXPECT_LT(LargestDistance(*result, window.leader), 1e-5f);
}

TEST(NetworkSynthesizer, AnswersWindowsInOrder) {
  const auto model = Model(LargerAndHigher);
  const SynthesisWindow a = Window(3), b = Window(7);
  const std::vector<WindowResult> results = model->Synthesize({&a, &b});
  ASSERT_EQ(results.size(), 2u);
  EXPECT_EQ(results[0]->frame_count(), 3);
  EXPECT_EQ(results[1]->frame_count(), 7);
  EXPECT_TRUE(model->Synthesize({}).empty());
}

TEST(NetworkSynthesizer, LimbsKeepTheLengthsOfTheStartOrElseTheLeader) {
  const auto model = Model(LargerAndHigher);
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  SynthesisWindow window = Window();
  const auto expect_lengths = [&](const motion::Poses& owner) {
    const WindowResult result = RunOne(*model, window);
    ASSERT_THAT(result, IsOk());
    const std::vector<float> wanted = MedianBoneLengths(skeleton, owner);
    for (int t = 0; t < result->frame_count(); ++t) {
      for (std::size_t b = 0; b < wanted.size(); ++b) {
        const motion::Bone& bone = skeleton.bones[b];
        EXPECT_NEAR(Distance(result->at(t, bone.parent), result->at(t, bone.child)), wanted[b],
                    1e-4f);
      }
    }
  };
  expect_lengths(window.leader);
  window.start = FollowerStart{{0, 1, -1}, {}};  // the root alone: still the leader's
  expect_lengths(window.leader);
  std::vector<motion::Vec3> tall = SwayingPose(0);
  for (motion::Vec3& joint : tall) joint = joint * 1.1f + motion::Vec3{0, 0, -1};
  window.start = FollowerStart{tall[2], tall};
  expect_lengths(motion::Poses(15, tall));
}

TEST(NetworkSynthesizer, LimbsWithoutAPoseHaveTheModelsRatiosToThoseOfTheLeader) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  ModelDescription description = test::FakeDescription();
  description.bone_ratios.assign(skeleton.bones.size(), 0.9);
  description.bone_ratios.back() = 1.1;
  const auto model = Model(LargerAndHigher, true, description);
  SynthesisWindow window = Window();
  const auto expect = [&](const motion::Poses& owner, float ratio, float last) {
    const WindowResult result = RunOne(*model, window);
    ASSERT_THAT(result, IsOk());
    const std::vector<float> now = MedianBoneLengths(skeleton, *result),
                             lengths = MedianBoneLengths(skeleton, owner);
    EXPECT_NEAR(now.front(), ratio * lengths.front(), 1e-4f);
    EXPECT_NEAR(now.back(), last * lengths.back(), 1e-4f);
  };
  expect(window.leader, 0.9f, 1.1f);
  const std::vector<motion::Vec3> pose = SwayingPose(0);
  window.start = FollowerStart{pose[2], pose};
  expect(motion::Poses(15, pose), 1, 1);
}

// How far the follower of a window is turned away at the end, degrees, if the network turns it away
// by 150 all the time. `weights` are those of the first classes.
float AwayAtTheEnd(const std::vector<FacingClass>& facing, std::vector<float> weights,
                   std::optional<int64_t> first_frame = {}, bool clean_up = true) {
  ModelDescription description = test::SamplingDescription();
  description.facing_classes = facing;
  weights.resize(description.classes.size());
  SynthesisWindow window = Window(45);
  window.leader = test::Puppet({}, 45);
  window.labels.clear();
  for (int t = 0; t < 45; ++t) {
    window.labels.insert(window.labels.end(), weights.begin(), weights.end());
  }
  window.options.clean_up = clean_up;
  window.options.sampling.first_frame = first_frame;
  const motion::Poses away = test::Changed(test::Puppet({}, 45), [](int, motion::Vec3 joint) {
    return RotateY(joint, 150 * base::kRadiansPerDegree) + motion::Vec3{0, 0, -1};
  });
  const auto model =
      Model([&](Inputs inputs) { return std::vector<motion::Poses>(inputs.size(), away); }, true,
            description);
  const WindowResult result = RunOne(*model, window);
  if (!result.ok()) return 0;
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  return std::abs(
      solver::DegreesAway(skeleton, body::FindBody(skeleton), window.leader, *result, 15).back());
}

TEST(NetworkSynthesizer, TurnsAFollowerBackInClassesInWhichPeopleFaceEachOther) {
  const std::vector<std::string> classes = test::SamplingDescription().classes;
  ASSERT_GE(classes.size(), 2u);
  const std::vector<FacingClass> first = {{classes[0], 50}};
  const std::vector<FacingClass> both = {{classes[0], 50}, {classes[1], 30}};
  EXPECT_NEAR(AwayAtTheEnd({}, {1}), 150, 3);
  EXPECT_LT(AwayAtTheEnd(first, {1}), 60);
  EXPECT_LT(AwayAtTheEnd(first, {1}, 0), 60);  // live, too
  EXPECT_NEAR(AwayAtTheEnd(first, {1}, {}, /*clean_up=*/false), 150, 3);
  EXPECT_NEAR(AwayAtTheEnd(first, {0, 1}), 150, 3);  // people turn round in this one
  EXPECT_NEAR(AwayAtTheEnd(both, {-1, 0}), AwayAtTheEnd({}, {1}), 3);  // nothing told
  EXPECT_LT(AwayAtTheEnd(both, {0.5f, 0.5f}), 60);
}

float LowestFoot(const motion::Poses& poses) {
  return motion::LowestFoot(*motion::SbuSkeleton().feet, poses);
}

TEST(NetworkSynthesizer, FollowerWithoutAStartStandsOnTheLeadersFloor) {
  const auto model = Model(LargerAndHigher);
  SynthesisWindow window = Window();
  const WindowResult shared = RunOne(*model, window);
  EXPECT_NEAR(LowestFoot(*shared), LowestFoot(window.leader), 1e-5f);
  window.start = FollowerStart{window.leader.at(0, 2), {}};  // too close to tell a direction
  const WindowResult started = RunOne(*model, window);
  EXPECT_GT(std::abs(LowestFoot(*started) - LowestFoot(window.leader)), 0.1f);
}

TEST(NetworkSynthesizer, WithoutFeetNoFloorIsShared) {
  ModelDescription footless = FakeDescription();
  footless.skeleton.feet.reset();
  const SynthesisWindow window = Window();
  const WindowResult got = RunOne(*Model(LargerAndHigher, true, footless), window);
  ASSERT_THAT(got, IsOk());
  EXPECT_GT(LowestFoot(*got) - LowestFoot(window.leader), 0.1f);
}

TEST(NetworkSynthesizer, OnlyTheWindowThatIsNotFiniteFails) {
  const auto model = Model([](Inputs inputs) {
    Answer followers = LargerAndHigher(inputs);
    (*followers)[1].at(2, 7).y = std::numeric_limits<float>::quiet_NaN();
    return followers;
  });
  const SynthesisWindow window = Window();
  const std::vector<WindowResult> results = model->Synthesize({&window, &window, &window});
  EXPECT_THAT(results[0], IsOk());
  EXPECT_THAT(results[1], StatusIs(absl::StatusCode::kInternal, HasSubstr("not finite")));
  EXPECT_THAT(results[2], IsOk());
}

TEST(NetworkSynthesizer, AFailureIsEveryWindows) {
  const auto model = Model([](Inputs) -> Answer { return absl::InternalError("out of order"); });
  const SynthesisWindow window = Window();
  const std::vector<WindowResult> results = model->Synthesize({&window, &window});
  ASSERT_EQ(results.size(), 2u);
  for (const WindowResult& result : results) {
    EXPECT_THAT(result, StatusIs(absl::StatusCode::kInternal, HasSubstr("out of order")));
  }
}

TEST(NetworkSynthesizer, AnAnswerOfAnotherShapeIsRefused) {
  const SynthesisWindow window = Window(3);
  const auto refused = [&](std::vector<motion::Poses> answer, const char* why) {
    const auto model = Model([&](Inputs) { return answer; });
    EXPECT_THAT(RunOne(*model, window), StatusIs(absl::StatusCode::kInternal, HasSubstr(why)));
  };
  refused({}, "answered 0 windows, expected 1");
  refused({motion::Poses(2, 15)}, "answered 2 frames of 15 joints, expected 3 of 15");
  refused({motion::Poses(3, 14)}, "answered 3 frames of 14 joints, expected 3 of 15");
}

TEST(NetworkSynthesizer, OnlyTheCancelledWindowFails) {
  std::vector<SynthesisWindow> windows = {Window(), Window(), Window()};
  windows[1].cancelled = std::make_shared<std::atomic<bool>>(true);
  windows[2].cancelled = std::make_shared<std::atomic<bool>>(false);
  const auto results = Model(LargerAndHigher)->Synthesize({&windows[0], &windows[1], &windows[2]});
  EXPECT_THAT(results[0], IsOk());
  EXPECT_THAT(results[1], StatusIs(absl::StatusCode::kCancelled, HasSubstr("cancelled")));
  EXPECT_THAT(results[2], IsOk());
}

TEST(NetworkSynthesizer, TheNetworkSeesAWindowCancelledMeanwhile) {
  SynthesisWindow window = Window();
  const auto cancelled = std::make_shared<std::atomic<bool>>(false);
  window.cancelled = cancelled;
  const auto model = Model([&](Inputs inputs) -> Answer {
    EXPECT_FALSE(AllCancelled(inputs));
    cancelled->store(true);
    EXPECT_TRUE(AllCancelled(inputs));
    return LargerAndHigher(inputs);
  });
  EXPECT_THAT(RunOne(*model, window),
              StatusIs(absl::StatusCode::kCancelled, HasSubstr("cancelled")));
}

// A follower that stands beside the leader, turned by some angle, with an arm that grows.
motion::Poses Follower(int frames) {
  motion::Poses follower = SwayingMotion(frames, 15);
  for (int t = 0; t < frames; ++t) {
    for (motion::Vec3& joint : follower[t]) joint += motion::Vec3{0, 0.1f, -1};
    follower.at(t, 8).x += 0.02f * static_cast<float>(t);
  }
  return follower;
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
    const auto model = Model(says, true, description);
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

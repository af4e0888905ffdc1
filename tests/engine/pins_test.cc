// What pins do on their way through windows, candidates and resampling.
#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "gtest/gtest.h"
#include "model/body/limbs.h"
#include "model/engine/candidates.h"
#include "model/engine/clip_synthesis.h"
#include "model/engine/network_synthesizer.h"
#include "tests/engine/rule_network.h"
#include "tests/support/fake_synthesizer.h"
#include "tests/support/sample_motion.h"

namespace duet::engine {
namespace {

using motion::Pin;
using motion::Pins;
using motion::Vec3;
using test::FakeDescription;
using test::SamplingDescription;
using test::SwayingMotion;

constexpr int kRightHand = 8, kRightShoulder = 6, kHead = 0;

constexpr int kReturnFrames = 10;

// Goes on from the settled frames, and from their last pose returns to its own motion.
void Continue(const motion::Poses& settled, motion::Poses* follower) {
  const int known = settled.frame_count();
  if (known == 0) return;
  for (int j = 0; j < follower->joint_count(); ++j) {
    const Vec3 apart = settled.at(known - 1, j) - follower->at(known - 1, j);
    for (int t = 0; t < known; ++t) follower->at(t, j) = settled.at(t, j);
    for (int t = known; t < std::min(known + kReturnFrames, follower->frame_count()); ++t) {
      const float share = static_cast<float>(t - known + 1) / kReturnFrames;
      follower->at(t, j) += apart * (1 - share * share * (3 - 2 * share));
    }
  }
}

// Stands 1.5 m from the leader, and up to 30 cm farther to the side for other seeds.
Answer Stand(Inputs inputs) {
  std::vector<motion::Poses> followers;
  for (const NetworkInput& input : inputs) {
    motion::Poses follower = input.leader;
    const float aside = 0.1f * static_cast<float>(input.sampling.seed % 4);
    for (Vec3& joint : follower.all()) joint += Vec3{aside, 0, -1.5f};
    Continue(input.settled, &follower);
    followers.push_back(std::move(follower));
  }
  return followers;
}

std::unique_ptr<Synthesizer> Model(ModelDescription description = SamplingDescription()) {
  return MakeSynthesizer(std::move(description), motion::StandardOrigin::kFirstFrame,
                         std::make_unique<RuleNetwork>(Stand));
}

ClipRequest Request(int frames, double frame_rate_hz, Pins pins = {}) {
  ClipRequest request{SwayingMotion(frames, frame_rate_hz),
                      frame_rate_hz,
                      LabelTrack(std::vector<float>(6, 0)),
                      std::nullopt,
                      std::nullopt,
                      {}};
  request.options.clean_up = true;
  request.pins = std::move(pins);
  return request;
}

struct Outcome {
  motion::Poses follower{0, 15};
  std::vector<SynthesisWindow> windows;
  std::vector<float> distances;
};

Outcome Synthesized(const Synthesizer& model, ClipRequest request) {
  ClipSynthesis clip(model.description(), std::move(request));
  Outcome outcome;
  while (clip.HasNextWindow()) {
    outcome.windows.push_back(clip.NextWindow());
    const SynthesisWindow* window = &outcome.windows.back();
    outcome.follower.Append(clip.Accept(*model.Synthesize({window}).front()).all());
  }
  outcome.distances = clip.pin_distances();
  return outcome;
}

// A place that the right hand of an unpinned follower can get to by its arm.
Pin Reachable(const motion::Poses& follower, int frame) {
  const Vec3 shoulder = follower.at(frame, kRightShoulder);
  const Vec3 ahead = body::Facing(*motion::SbuSkeleton().hips, follower[frame]);
  return {kRightHand, static_cast<double>(frame), shoulder + ahead * 0.35f + Vec3{0, 0.1f, 0}};
}

float LargestSpeed(const motion::Poses& poses, double frame_rate_hz) {
  float largest = 0;
  for (int t = 1; t < poses.frame_count(); ++t) {
    largest = std::max(largest, Distance(poses.at(t, kRightHand), poses.at(t - 1, kRightHand)));
  }
  return largest * static_cast<float>(frame_rate_hz);
}

TEST(PinsOfAClip, AreReachedInTheCallersFramesAtAnyRate) {
  const std::unique_ptr<Synthesizer> model = Model();
  for (const double rate : {15.0, 24.0, 60.0, 120.0, 7.0}) {
    const int frames = static_cast<int>(8 * rate);
    const motion::Poses free = Synthesized(*model, Request(frames, rate)).follower;
    Pins pins;
    for (const double seconds : {0.0, 0.9, 2.1, 3.05, 4.4, 6.2, 7.8}) {
      pins.push_back(Reachable(free, static_cast<int>(seconds * rate)));
    }
    const Outcome outcome = Synthesized(*model, Request(frames, rate, pins));
    ASSERT_GT(outcome.windows.size(), 1u);
    for (std::size_t i = 0; i < pins.size(); ++i) {
      const int frame = static_cast<int>(pins[i].frame);
      const float distance = Distance(outcome.follower.at(frame, kRightHand), pins[i].position);
      EXPECT_LT(distance, 0.01f) << rate << " Hz, frame " << frame;
      EXPECT_EQ(outcome.distances[i], distance);
    }
    EXPECT_LT(LargestSpeed(outcome.follower, rate), 4.5f);
  }
}

TEST(PinsOfAClip, EveryFrameOfAChainCanBePinned) {
  const std::unique_ptr<Synthesizer> model = Model();
  // A pin that lets all of the distance remain: with pins, windows settle more.
  const Pins soft = {{kRightHand, 99, {}, 1}};
  const motion::Poses free = Synthesized(*model, Request(100, 15, soft)).follower;
  for (int frame = 30; frame < 70; ++frame) {
    const Outcome outcome = Synthesized(*model, Request(100, 15, {Reachable(free, frame)}));
    EXPECT_LT(outcome.distances[0], 0.01f) << frame;
    EXPECT_LT(LargestSpeed(outcome.follower, 15), 4.5f) << frame;
  }
}

TEST(PinsOfAClip, BelongToTheWindowsThatShowTheirFrameOrPrepareForIt) {
  const std::unique_ptr<Synthesizer> model = Model();
  const Outcome outcome = Synthesized(*model, Request(140, 15, {{kHead, 60, {0, 1.6f, -1.5f}}}));
  ASSERT_EQ(outcome.windows.size(), 4u);
  std::vector<std::size_t> counts;
  for (const SynthesisWindow& window : outcome.windows) counts.push_back(window.pins.size());
  EXPECT_EQ(counts, (std::vector<std::size_t>{1, 1, 0, 0}));
  EXPECT_EQ(outcome.windows[0].pins[0].frame, 60);
  EXPECT_LT(outcome.windows[1].pins[0].frame, 46);
}

TEST(PinsOfAClip, WithoutPinsNotABitChanges) {
  const std::unique_ptr<Synthesizer> model = Model();
  const Outcome none = Synthesized(*model, Request(100, 24));
  EXPECT_TRUE(none.distances.empty());
  for (const SynthesisWindow& window : none.windows) EXPECT_TRUE(window.pins.empty());
  // A pin near the end leaves the frames before the second window as they are.
  const Outcome late = Synthesized(*model, Request(100, 24, {Reachable(none.follower, 95)}));
  for (int t = 0; t < 26; ++t) {
    for (int j = 0; j < 15; ++j) EXPECT_EQ(late.follower.at(t, j), none.follower.at(t, j)) << t;
  }
}

TEST(PinsOfAClip, AreHonouredWithoutCleanUpAndByModelsWithOneAnswer) {
  const std::unique_ptr<Synthesizer> model = Model(FakeDescription());
  ClipRequest request = Request(40, 15);
  request.options.clean_up = false;
  const motion::Poses free = Synthesized(*model, request).follower;
  request.pins = {Reachable(free, 20)};
  const Outcome outcome = Synthesized(*model, request);
  EXPECT_LT(outcome.distances[0], 0.01f);
  for (int t = 0; t < 40; ++t) EXPECT_EQ(outcome.follower.at(t, 11), free.at(t, 11)) << "foot";
}

TEST(PinsOfAClip, ACandidateThatIsNearWins) {
  const std::unique_ptr<Synthesizer> model = Model();
  ClipRequest request = Request(40, 15);
  request.options.sampling.candidates = 8;
  const motion::Poses free = Synthesized(*model, request).follower;
  // A softness of 1 only chooses. For each side of the samples, another one is the nearest.
  std::vector<float> places;
  for (const float aside : {-1.0f, 1.0f}) {
    request.pins = {{kHead, 20, free.at(20, kHead) + Vec3{aside, 0, 0}, 1}};
    places.push_back(Synthesized(*model, request).follower.at(20, kHead).x);
  }
  EXPECT_GT(places[1], places[0] + 0.1f);
}

}  // namespace
}  // namespace duet::engine

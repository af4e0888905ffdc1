#include "model/engine/mixture.h"

#include <cmath>

#include "gmock/gmock.h"
#include "model/motion/skeleton.h"
#include "tests/support/bodies.h"

namespace duet::engine {
namespace {

using motion::Poses;
using motion::Vec3;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::FloatNear;

constexpr int kShake = 0, kHug = 1, kPush = 2, kKick = 3, kClasses = 4;
constexpr int kLength = 30, kJoints = 15;
constexpr int kHit = 12;  // the frame in which the leader's hand is furthest

ModelDescription Model() {
  ModelDescription model;
  model.skeleton = motion::SbuSkeleton();
  model.classes = {"shake", "hug", "push", "kick"};
  model.touching_classes = {"hug"};
  model.hand_contacts = {{"shake", 0.1}};
  model.frame_rate_hz = 15;
  model.samples = model.labels_guide = true;
  return model;
}

// A leader who stands at the origin and reaches towards -z with one hand.
NetworkInput Window(std::vector<float> weights) {
  NetworkInput window;
  window.leader = Poses(kLength, kJoints);
  constexpr int kHand = 8;
  for (int t = 0; t < kLength; ++t) {
    window.leader.at(t, kHand).z =
        -0.6f * std::exp(-0.05f * static_cast<float>((t - kHit) * (t - kHit)));
  }
  for (int t = 0; t < kLength; ++t) {
    window.labels.insert(window.labels.end(), weights.begin(), weights.end());
  }
  return window;
}

Mixture MixtureOf(const NetworkInput& window, const ModelDescription& model = Model()) {
  return Mixture(model, body::FindBody(model.skeleton), window);
}

// The weights of the first frame of each evaluation.
std::vector<std::vector<float>> Evaluated(const NetworkInput& window,
                                          const ModelDescription& model = Model()) {
  std::vector<NetworkInput> inputs;
  MixtureOf(window, model).AddInputs(window, &inputs);
  std::vector<std::vector<float>> weights;
  for (const NetworkInput& input : inputs) {
    weights.emplace_back(input.labels.begin(), input.labels.begin() + kClasses);
  }
  return weights;
}

// A network whose answer to a class moves every joint by the class's way in each frame, after the
// known frames. Its answers to weights add up, and it goes with the leader's hand.
Poses AnswerTo(const NetworkInput& input) {
  static constexpr Vec3 kWays[kClasses] = {
      {0, 0, 0.02f}, {0, 0, 0.04f}, {0, 0, -0.05f}, {0.03f, 0, -0.03f}};
  Poses answer(kLength, kJoints);
  for (int t = 0; t < kLength; ++t) {
    for (Vec3& joint : answer[t]) {
      const float since =
          static_cast<float>(std::max(0, t - std::max(0, input.settled.frame_count() - 1)));
      for (std::size_t c = 0; c < kClasses; ++c) joint += since * input.labels[c] * kWays[c];
      joint.y += input.leader.at(t, 8).z;
    }
  }
  return answer;
}

Poses Answer(const NetworkInput& window) {
  const Mixture mixture = MixtureOf(window);
  std::vector<NetworkInput> inputs;
  mixture.AddInputs(window, &inputs);
  std::vector<Poses> answers;
  for (const NetworkInput& input : inputs) answers.push_back(AnswerTo(input));
  return mixture.Combine(answers);
}

TEST(Mixture, OneLabelIsTheNetworksOwnAnswer) {
  for (const std::vector<float>& weights :
       {std::vector<float>{0, 0, 1, 0}, {0, 0.5f, 0, 0}, {0, 0, 0, 0}, {0, -1, 0, 0}}) {
    const NetworkInput window = Window(weights);
    EXPECT_THAT(Evaluated(window), ElementsAre(weights));
    EXPECT_EQ(Answer(window), AnswerTo(window));
    EXPECT_EQ(MixtureOf(window).labels(), window.labels);
  }
}

TEST(Mixture, ClassesOfOneKindAreLeftToTheNetwork) {
  EXPECT_THAT(Evaluated(Window({0, 0, 0.5f, 0.75f})), ElementsAre(ElementsAre(0, 0, 0.5f, 0.75f)));
  EXPECT_THAT(Evaluated(Window({1, 0.5f, 0, 0})), ElementsAre(ElementsAre(1, 0.5f, 0, 0)));
}

TEST(Mixture, ANetworkThatReadsLabelsGetsThem) {
  ModelDescription model = Model();
  model.labels_guide = false;
  NetworkInput window = Window({1, -1, 1, 0});
  window.sampling.reaction = 2;
  EXPECT_THAT(Evaluated(window, model), ElementsAre(ElementsAre(1, -1, 1, 0)));
}

TEST(Mixture, ContactComesFirstAndTheOtherClassAfterTheLeadersReach) {
  const NetworkInput window = Window({0, 0.5f, 0.5f, 0});
  EXPECT_THAT(Evaluated(window),
              ElementsAre(ElementsAre(0, 1, 0, 0), ElementsAre(0, 0, 1, 0), Each(0.0f)));
  const std::vector<float> labels = MixtureOf(window).labels();
  EXPECT_NEAR(labels[kHug], 1.25, 0.01);
  EXPECT_NEAR(labels[kPush], 0.25, 0.01);
  EXPECT_NEAR(labels[(kLength - 1) * kClasses + kHug], 0.25, 0.01);
  EXPECT_NEAR(labels[(kLength - 1) * kClasses + kPush], 1.25, 0.01);
  // The body goes on as the answer of the time goes, from where it is.
  const Poses answer = Answer(window);
  const auto step = [&](int t) { return answer.at(t + 1, 2).z - answer.at(t, 2).z; };
  EXPECT_NEAR(step(2), 1.25 * 0.04 - 0.25 * 0.05, 1e-3);
  EXPECT_NEAR(step(kLength - 2), 0.25 * 0.04 - 1.25 * 0.05, 1e-3);
}

TEST(Mixture, TwoWholeWeightsAreThereAllOfTheTime) {
  const NetworkInput window = Window({0, 1, 1, 0});
  const std::vector<float> labels = MixtureOf(window).labels();
  for (std::size_t t = 0; t < kLength; ++t) {
    EXPECT_GE(labels[t * kClasses + kHug], 0.75f) << t;
    EXPECT_GE(labels[t * kClasses + kPush], 0.75f) << t;
    EXPECT_FLOAT_EQ(labels[t * kClasses + kHug] + labels[t * kClasses + kPush], 2) << t;
  }
}

TEST(Mixture, ALeaderWhoDoesNotReachGivesTheMean) {
  NetworkInput window = Window({0, 0.5f, 0.5f, 0});
  for (Vec3& joint : window.leader.all()) joint = {};
  for (int t = 0; t < kLength; ++t) {
    EXPECT_NEAR(Answer(window).at(t, 0).z, -0.005f * static_cast<float>(t), 1e-5) << t;
  }
}

TEST(Mixture, AWeightMovesTheAnswerSmoothly) {
  Poses before = AnswerTo(Window({0, 0, 1, 0}));
  for (int step = 1; step <= 20; ++step) {
    const float share = static_cast<float>(step) / 20;
    const Poses answer = Answer(Window({0, share, 1 - share, 0}));
    float most = 0;
    for (std::size_t i = 0; i < answer.all().size(); ++i) {
      most = std::max(most, Distance(answer.all()[i], before.all()[i]));
    }
    // The two answers are up to 2.6 m apart.
    EXPECT_LT(most, 0.35f) << share;
    before = answer;
  }
  EXPECT_EQ(before, AnswerTo(Window({0, 1, 0, 0})));
}

TEST(Mixture, ContinuesFromKnownFrames) {
  NetworkInput window = Window({0, 0.5f, 0.5f, 0});
  window.settled = Poses(8, kJoints);
  const Poses answer = Answer(window), hug = [&] {
    NetworkInput alone = Window({0, 1, 0, 0});
    alone.settled = window.settled;
    return AnswerTo(alone);
  }();
  for (int t = 0; t < 8; ++t) EXPECT_EQ(answer[t], hug[t]) << t;
}

TEST(Mixture, AnAvoidedClassLeavesTheRequestAlone) {
  const Poses push = AnswerTo(Window({0, 0, 1, 0}));
  // The way of an embrace is the opposite of a push's: there is nothing beside the request.
  const Poses no_hug = Answer(Window({0, -1, 1, 0}));
  for (std::size_t i = 0; i < push.all().size(); ++i) {
    EXPECT_LT(Distance(no_hug.all()[i], push.all()[i]), 1e-4f);
  }
  // A kick also moves the follower to the side: half as far as the push moves it, at most.
  const Poses no_kick = Answer(Window({0, 0, 1, -1}));
  const int last = kLength - 1;
  EXPECT_NEAR(no_kick.at(last, 2).z, push.at(last, 2).z, 1e-3);
  EXPECT_NEAR(no_kick.at(last, 2).x, -0.025f * last, 1e-3);
  EXPECT_THAT(Evaluated(Window({0, 0, 1, -1})),
              ElementsAre(ElementsAre(0, 0, 1, 0), Each(0.0f), ElementsAre(0, 0, 0, 1)));
}

TEST(Mixture, ReactionScalesWhatTheLeadersMotionMakes) {
  for (const float reaction : {0.0f, 0.5f, 1.0f, 2.0f}) {
    NetworkInput window = Window({0, 0, 1, 0});
    window.sampling.reaction = reaction;
    const float still = window.leader.at(0, 8).z, moved = window.leader.at(kHit, 8).z;
    EXPECT_THAT(Answer(window).at(kHit, 2).y, FloatNear(still + reaction * (moved - still), 1e-5f));
    EXPECT_EQ(MixtureOf(window).evaluations(), reaction == 1 ? 1 : 2);
  }
}

TEST(Mixture, LabelsMayChangeWithinAWindow) {
  NetworkInput window = Window({0, 0, 1, 0});
  for (int t = kLength / 2; t < kLength; ++t) {
    window.labels[static_cast<std::size_t>(t) * kClasses + kHug] = 1;
    window.labels[static_cast<std::size_t>(t) * kClasses + kPush] = 0;
  }
  const std::vector<float> labels = MixtureOf(window).labels();
  EXPECT_EQ(labels, window.labels) << "only one of them is asked for at a time";
}

}  // namespace
}  // namespace duet::engine

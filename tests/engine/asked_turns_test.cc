#include "model/engine/asked_turns.h"

#include <cmath>
#include <cstdint>
#include <set>

#include "gmock/gmock.h"
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
using test::FakeDescription;

constexpr int kFrames = 45;
constexpr int kTurn = 1;  // class of the turn
constexpr double kSpeed = 240;

ModelDescription Description(int lookahead = 0) {
  ModelDescription description = FakeDescription();
  description.frame_rate_hz = kRate;
  description.lookahead_frames = lookahead;
  description.turning_classes = {{description.classes[kTurn], kSpeed}};
  return description;
}

// A person in front of the leader who turns at `speed` degrees a second in frames [begin, end).
Poses Turning(double speed, int begin = 0, int end = kFrames) {
  const auto turned = [=](int t, Vec3 joint) {
    const double degrees = speed * std::clamp(t - begin, 0, end - begin) / kRate;
    return RotateY(joint, degrees * 3.14159265 / 180);
  };
  return Moved(Changed(Puppet({}, kFrames), turned), {0, 0, 0.8f});
}

// The weight of the turn in frames [begin, end); all other weights are 0.
SynthesisWindow Window(float weight, int begin = 0, int end = kFrames) {
  SynthesisWindow window;
  window.leader = Puppet({}, kFrames);
  const std::size_t classes = FakeDescription().classes.size();
  window.labels.resize(kFrames * classes);
  for (int t = begin; t < end; ++t) {
    window.labels[static_cast<std::size_t>(t) * classes + kTurn] = weight;
  }
  return window;
}

double Miss(const SynthesisWindow& window, const Poses& follower, int lookahead = 0,
            const std::vector<double>& ways = {}) {
  const AskedTurns turns(Description(lookahead), window);
  return turns.Miss(turns.TurnsOf(window.leader, follower), ways);
}

// The farthest turn of a follower in each turn that the window asks for.
std::vector<double> TurnedOneWay(const SynthesisWindow& window, const Poses& follower) {
  const AskedTurns turns(Description(), window);
  return turns.Asked(turns.TurnsOf(window.leader, follower));
}

// The window, whose label of a turn began `frames` frames before it, in which the follower turned
// by `degrees` in all, and goes on for `after` frames.
SynthesisWindow GoingOn(SynthesisWindow window, int frames, double degrees, int after = 0) {
  // Frame 0 of the window has the label as well.
  window.turns_around.before.assign(static_cast<std::size_t>(frames) + 1, degrees / (frames + 1));
  window.turns_around.after = after;
  return window;
}

bool Asks(const SynthesisWindow& window) { return AskedTurns(Description(), window).asks(); }

// The window, with another class at 1 in frames [begin, end).
SynthesisWindow WithAnother(SynthesisWindow window, int begin, int end) {
  const std::size_t classes = FakeDescription().classes.size();
  for (int t = begin; t < end; ++t) {
    window.labels[static_cast<std::size_t>(t) * classes + kTurn + 1] = 1;
  }
  return window;
}

TEST(AskedTurns, AWholeTurnIsWhatIsAskedFor) {
  for (const double speed : {kSpeed, -kSpeed}) EXPECT_EQ(Miss(Window(1), Turning(speed)), 0);
  EXPECT_NEAR(Miss(Window(1), Turning(0)), 1, 1e-6);
  const double half = Miss(Window(1), Turning(kSpeed / 4));
  EXPECT_GT(half, 0.4);
  EXPECT_LT(half, 0.8);
}

TEST(AskedTurns, AShortLabelAsksForAWholeTurnToo) {
  const SynthesisWindow window = Window(1, 0, 20);
  EXPECT_EQ(Miss(window, Turning(1.3 * kSpeed, 0, 20)), 0);
  EXPECT_GT(Miss(window, Turning(0.6 * kSpeed, 0, 20)), 0.1);
}

TEST(AskedTurns, ALongLabelAsksForSeveralTurns) {
  EXPECT_EQ(TurnedOneWay(Window(1), Turning(kSpeed)).size(), 1u);
  // 6 s with the label, and 2.25 s for each turn.
  const std::vector<double> turned = TurnedOneWay(GoingOn(Window(1), 45, 0), Turning(kSpeed));
  EXPECT_EQ(turned.size(), 2u);
}

TEST(AskedTurns, WhatTheFollowerTurnedBeforeTheWindowCounts) {
  const SynthesisWindow window = Window(1, 0, 15);
  EXPECT_GT(Miss(window, Turning(0)), 0.3);
  EXPECT_TRUE(Asks(window));
  for (const double turned : {370.0, -370.0}) {
    EXPECT_EQ(Miss(GoingOn(window, 15, turned), Turning(0)), 0);
    EXPECT_FALSE(Asks(GoingOn(window, 15, turned)));
  }
  // The rest of a turn goes the same way.
  const Poses rest = Turning(200, 0, 15);
  EXPECT_EQ(Miss(GoingOn(window, 15, TurnedOneWay(window, rest)[0]), rest), 0);
  EXPECT_GT(Miss(GoingOn(window, 15, -TurnedOneWay(window, rest)[0]), rest), 0.1);
}

TEST(AskedTurns, SettledFramesCountAsWell) {
  SynthesisWindow window = Window(1, 0, 25);
  window.settled = Turning(370, 0, 15);
  window.settled.Resize(16);
  EXPECT_FALSE(Asks(window));
  window.settled = Puppet({}, 16);
  EXPECT_TRUE(Asks(window));
}

TEST(AskedTurns, AWindowThatSeesTheBeginningOfATurnAsksForLessOrNothing) {
  const auto begins = [](int after) { return GoingOn(Window(1, 30), 0, 0, after); };
  EXPECT_GT(Miss(begins(0), Turning(0)), 0.3);
  EXPECT_GT(Miss(begins(0), Turning(kSpeed, 30)), 0.05);
  EXPECT_EQ(Miss(begins(15), Turning(kSpeed, 30)), 0);
  EXPECT_GT(Miss(begins(15), Turning(0)), 0.3);
  const SynthesisWindow little = GoingOn(Window(1, 38), 0, 0, 22);
  EXPECT_EQ(Miss(little, Turning(0)), 0);
  EXPECT_FALSE(Asks(little));
}

TEST(AskedTurns, OneTurnGoesOneWay) {
  EXPECT_EQ(Miss(Window(1), Turning(2 * kSpeed, 0, 23)), 0);
  const auto turned = [](int t, Vec3 joint) {
    const double degrees = 2 * kSpeed * (t < 23 ? t : 46 - t) / kRate;
    return RotateY(joint, degrees * 3.14159265 / 180);
  };
  const Poses back = Moved(Changed(Puppet({}, kFrames), turned), {0, 0, 0.8f});
  EXPECT_GT(Miss(Window(1), back), 0.3);
}

TEST(AskedTurns, SwayingIsNoTurn) {
  Poses follower = Turning(kSpeed, 0, 4);
  for (int t = 4; t < kFrames; ++t) {
    const int swayed = std::abs(t % 8 - 4);
    std::copy(follower[swayed].begin(), follower[swayed].end(), follower[t].begin());
  }
  EXPECT_GT(Miss(Window(1), follower), 0.7);
  EXPECT_EQ(Miss(Window(-1), follower), 0);
}

TEST(AskedTurns, OneWayIsEnoughUnlessItIsGiven) {
  const std::vector<double> turns = TurnedOneWay(Window(1), Turning(kSpeed));
  ASSERT_EQ(turns.size(), 1u);
  EXPECT_NEAR(std::abs(turns[0]), kSpeed * (kFrames - 1) / kRate, 20);
  EXPECT_NEAR(TurnedOneWay(Window(1), Turning(-kSpeed))[0], -turns[0], 1);
  EXPECT_EQ(Miss(Window(1), Turning(kSpeed), 0, turns), 0);
  // Turning the other way counts less, but more than not turning.
  EXPECT_EQ(Miss(Window(1), Turning(0.6 * kSpeed), 0, turns), 0);
  const double other_way = Miss(Window(1), Turning(-0.6 * kSpeed), 0, turns);
  EXPECT_GT(other_way, 0.1);
  EXPECT_LT(other_way, 0.4);
  EXPECT_NEAR(Miss(Window(1), Turning(0), 0, turns), 1, 1e-6);
}

TEST(AskedTurns, AnotherClassAvoidsWholeTurns) {
  SynthesisWindow window = WithAnother(Window(0), 0, kFrames);
  EXPECT_EQ(AskedTurns(Description(), window).demand(), 1);
  EXPECT_EQ(Miss(window, Turning(55)), 0);  // nearly half a turn
  EXPECT_GT(Miss(window, Turning(70)), 0);  // nearly two thirds of one
  EXPECT_GT(Miss(window, Turning(kSpeed)), 1);
  // Where a turn is asked for as well, only the other frames are kept free of turns.
  window = WithAnother(Window(1, 0, 25), 0, kFrames);
  EXPECT_EQ(Miss(window, Turning(kSpeed, 0, 25)), 0);
  EXPECT_GT(Miss(window, Turning(kSpeed)), 0.2);
}

TEST(AskedTurns, ATurnInOtherClassesCountsFromTheSettledFramesOn) {
  SynthesisWindow window = WithAnother(Window(0), 0, kFrames);
  window.settled = Puppet({}, 15);
  // 150 degrees before the judged frames and 150 in them.
  const Poses follower = Turning(150, 0, 30);
  EXPECT_GT(Miss(window, follower), 0.3);
  EXPECT_EQ(Miss(window, Turning(150, 0, 15)), 0);
  EXPECT_EQ(Miss(window, Turning(150, 15, 30)), 0);
  // What was asked for in the settled frames is no turn of another class.
  window = WithAnother(Window(1, 0, 15), 15, kFrames);
  window.settled = Puppet({}, 15);
  EXPECT_EQ(Miss(window, follower), 0);
}

TEST(AskedTurns, AnAvoidedTurnIsAMiss) {
  EXPECT_EQ(Miss(Window(-1), Turning(0)), 0);
  EXPECT_EQ(Miss(Window(-1), Turning(30)), 0);  // no faster than people turn in other classes
  EXPECT_GT(Miss(Window(-1), Turning(kSpeed)), 1);
}

TEST(AskedTurns, SmallerWeightsAskForLess) {
  EXPECT_GT(Miss(Window(1), Turning(kSpeed / 3)), 0.1);
  EXPECT_EQ(Miss(Window(0.5f), Turning(kSpeed / 3)), 0);
  EXPECT_NEAR(AskedTurns(Description(), Window(0.5f)).demand(), 0.5, 1e-6);
  EXPECT_NEAR(AskedTurns(Description(), Window(-0.5f)).demand(), 0.5, 1e-6);
}

TEST(AskedTurns, NothingIsAskedWithoutAWeightOrAClass) {
  EXPECT_EQ(AskedTurns(Description(), Window(0)).demand(), 0);
  EXPECT_EQ(AskedTurns(Description(), Window(1, 0, 2)).demand(), 0);
  EXPECT_EQ(AskedTurns(FakeDescription(), Window(1)).demand(), 0);
  EXPECT_EQ(Miss(Window(0), Turning(kSpeed)), 0);
  ModelDescription without_hips = Description();
  without_hips.skeleton.hips.reset();
  EXPECT_EQ(AskedTurns(without_hips, Window(1)).demand(), 0);
}

TEST(AskedTurns, OnlyFramesBetweenTheSettledOnesAndTheLookaheadAreJudged) {
  SynthesisWindow window = Window(1);
  EXPECT_GT(Miss(window, Turning(kSpeed, 30)), 0.3);
  window.settled = Puppet({}, 29);
  EXPECT_EQ(Miss(window, Turning(1.5 * kSpeed, 28)), 0);
  EXPECT_EQ(Miss(Window(1), Turning(kSpeed, 0, 20), kFrames - 20), 0);
  window.settled = Puppet({}, 40);
  EXPECT_EQ(AskedTurns(Description(10), window).demand(), 0);
}

std::vector<std::vector<double>> TurnsOf(const SynthesisWindow& window,
                                         const std::vector<Poses>& followers) {
  const AskedTurns turns(Description(), window);
  std::vector<std::vector<double>> samples;
  for (const Poses& follower : followers) {
    samples.push_back(turns.TurnsOf(window.leader, follower));
  }
  return samples;
}

bool Decided(const SynthesisWindow& window, const std::vector<Poses>& followers) {
  return IsDecided(AskedTurns(Description(), window), TurnsOf(window, followers));
}

TEST(IsDecided, WhereNoTurnIsAskedForByOneSampleThatDoesNotTurn) {
  EXPECT_TRUE(Decided(Window(-1), {Turning(0)}));
  EXPECT_FALSE(Decided(Window(-1), {Turning(kSpeed)}));
  EXPECT_TRUE(Decided(Window(-1), {Turning(kSpeed), Turning(0)}));
  const SynthesisWindow other = WithAnother(Window(0), 0, kFrames);
  EXPECT_TRUE(Decided(other, {Turning(0)}));
  EXPECT_FALSE(Decided(other, {Turning(kSpeed), Turning(-kSpeed)}));
}

TEST(IsDecided, WhereATurnIsAskedForByThreeSamplesThatAgreeOnItsWay) {
  const Poses turn = Turning(kSpeed), back = Turning(-kSpeed), little = Turning(20);
  EXPECT_FALSE(Decided(Window(1), {turn}));
  EXPECT_FALSE(Decided(Window(1), {turn, turn}));
  EXPECT_TRUE(Decided(Window(1), {turn, turn, turn}));
  EXPECT_TRUE(Decided(Window(1), {little, turn, little}));
  EXPECT_FALSE(Decided(Window(1), {little, little, little}));
  EXPECT_FALSE(Decided(Window(1), {turn, back, turn}));
  EXPECT_TRUE(Decided(Window(1), {turn, back, turn, turn, turn, turn}));
}

TEST(IsDecided, AfterFiveSamplesOfWhichOneTurnsMoreThanHalfway) {
  const Poses halfway = Turning(kSpeed / 3), little = Turning(20);
  EXPECT_FALSE(Decided(Window(1), {halfway, little, little}));
  EXPECT_TRUE(Decided(Window(1), {halfway, little, little, little, little}));
  EXPECT_FALSE(Decided(Window(1), {little, little, little, little, little}));
}

std::size_t Best(const SynthesisWindow& window, const std::vector<Poses>& followers) {
  return MostAsAsked(AskedTurns(Description(), window), TurnsOf(window, followers));
}

TEST(MostAsAsked, ChoosesASampleThatTurns) {
  EXPECT_EQ(Best(Window(1), {Turning(0), Turning(kSpeed), Turning(20)}), 1u);
  EXPECT_EQ(Best(Window(-1), {Turning(kSpeed), Turning(-kSpeed), Turning(20)}), 2u);
}

TEST(MostAsAsked, MostOfTheTurnsDecideTheWay) {
  const Poses turn = Turning(kSpeed), back = Turning(-kSpeed);
  EXPECT_EQ(Best(Window(1), {Turning(0), back, turn, turn}), 2u);
  EXPECT_EQ(Best(Window(1), {Turning(0), back, turn, back}), 1u);
}

TEST(MostAsAsked, ATurnAgainstTheOthersIsChosenOnlyIfTheseHardlyTurn) {
  const Poses enough = Turning(0.55 * kSpeed), little = Turning(0.4 * kSpeed);
  EXPECT_EQ(Best(Window(1), {enough, enough, Turning(-kSpeed)}), 0u);
  EXPECT_EQ(Best(Window(1), {little, little, little, Turning(-kSpeed)}), 3u);
  EXPECT_EQ(Best(Window(1), {little, little, little, Turning(-0.5 * kSpeed)}), 0u);
}

TEST(MostAsAsked, OfGoodSamplesTheMostTypicalIsChosen) {
  const Poses early = Turning(2 * kSpeed, 0, 20), middle = Turning(2 * kSpeed, 11, 31),
              late = Turning(2 * kSpeed, 22, 42);
  EXPECT_EQ(Best(Window(1), {early, late, middle}), 2u);
  EXPECT_EQ(Best(Window(1), {middle, early, late}), 0u);
}

TEST(DrawnAgain, NoSampleHasMoreNoiseThanACallerMayAskFor) {
  const SynthesisWindow window = Window(1);
  NetworkInput input;
  input.labels = window.labels;
  for (const float variety : {0.0f, 0.5f, 1.5f, 2.0f}) {
    input.sampling.variety = variety;
    const auto groups = DrawnAgain(Description(), AskedTurns(Description(), window), window, input);
    EXPECT_EQ(groups.back().back().sampling.variety, std::min(2.0f, 2 * variety));
  }
}

TEST(DrawnAgain, EachPairHasLargerLabelsOfTurnsAndNoLessNoise) {
  const SynthesisWindow window = Window(1);
  const AskedTurns turns(Description(), window);
  NetworkInput input;
  input.labels = window.labels;
  input.sampling.variety = 0.5f;
  std::set<uint64_t> seeds = {window.options.sampling.seed};
  std::size_t drawn = 0;
  float label = 1, variety = 0.5f;
  for (const std::vector<NetworkInput>& pair : DrawnAgain(Description(), turns, window, input)) {
    ASSERT_EQ(pair.size(), 2u);
    EXPECT_GT(pair[0].labels[kTurn], label);
    EXPECT_GE(pair[0].sampling.variety, variety);
    label = pair[0].labels[kTurn];
    variety = pair[0].sampling.variety;
    for (const NetworkInput& again : pair) {
      EXPECT_TRUE(seeds.insert(again.sampling.seed).second);
      EXPECT_EQ(again.labels[kTurn], label);
      EXPECT_EQ(again.sampling.variety, variety);
      EXPECT_EQ(again.labels[kTurn + 1], 0);
      ++drawn;
    }
  }
  EXPECT_GT(variety, 0.5f);
  input.labels = Window(-1).labels;
  const auto avoiding = DrawnAgain(Description(), turns, window, input);
  EXPECT_LT(avoiding.back().back().labels[kTurn], -label);  // enlarged more than labels that ask
  EXPECT_EQ(drawn, static_cast<std::size_t>(turns.further_samples()));
  EXPECT_EQ(drawn, 6u);
}

TEST(ExpectedSamples, CountsThoseThatLabelsOfTurnsAreExpectedToCost) {
  ModelDescription description = Description();
  description.samples = true;
  SynthesisWindow asking = Window(1), silent = Window(0);
  EXPECT_EQ(ExpectedSamples(description, silent), 1);
  EXPECT_GT(ExpectedSamples(description, asking), 2);
  EXPECT_LE(ExpectedSamples(description, asking), 7);
  const double half = ExpectedSamples(description, Window(0.5f));
  EXPECT_GT(half, 1);
  EXPECT_LT(half, ExpectedSamples(description, asking));
  asking.options.sampling.candidates = 3;
  EXPECT_GT(ExpectedSamples(description, asking), 4);
  asking.options.sampling.first_frame = 0;  // live windows are drawn once
  EXPECT_EQ(ExpectedSamples(description, asking), 3);
  description.samples = false;
  EXPECT_EQ(ExpectedSamples(description, asking), 1);
}

std::optional<double> Fitted(double speed, int stretches) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  TurningFit fit(skeleton);
  for (int i = 0; i < stretches; ++i) fit.Add(Puppet({}, kFrames), Turning(speed), 0, kFrames);
  return fit.DegreesPerSecond(kRate);
}

TEST(TurningFit, FindsTheSpeedOfAClassOfTurns) {
  ASSERT_TRUE(Fitted(120, 3).has_value());
  EXPECT_NEAR(*Fitted(-120, 3), 120, 5);
  EXPECT_EQ(Fitted(120, 2), std::nullopt);
  EXPECT_EQ(Fitted(40, 10), std::nullopt);
}

TEST(TurningFit, NeedsHips) {
  motion::Skeleton skeleton = motion::SbuSkeleton();
  skeleton.hips.reset();
  TurningFit fit(skeleton);
  for (int i = 0; i < 3; ++i) fit.Add(Puppet({}, kFrames), Turning(200), 0, kFrames);
  EXPECT_EQ(fit.DegreesPerSecond(kRate), std::nullopt);
}

}  // namespace
}  // namespace duet::engine

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "model/base/angle.h"
#include "model/motion/feet.h"
#include "model/motion/resample.h"
#include "model/training/augment.h"
#include "tests/support/matchers.h"
#include "tests/training/flow_test_options.h"
#include "tests/training/made_up_dataset.h"

namespace duet::training {
namespace {

using motion::Poses;
using motion::Vec3;

constexpr double kRate = 15;

// A person who stands upright and faces -z at a turn of 0, at a place of its own in every frame.
Poses Standing(int frames, const std::vector<Vec3>& places, const std::vector<double>& turns) {
  Poses poses = test::SteppingMotion({}, frames, kRate);
  for (int t = 0; t < frames; ++t) {
    const auto f = static_cast<size_t>(t);
    for (Vec3& point : poses[t]) point = RotateY(point, turns[f]) + places[f];
  }
  return poses;
}
Poses StandingAt(int frames, Vec3 place, double turn) {
  const auto count = static_cast<size_t>(frames);
  return Standing(frames, std::vector<Vec3>(count, place), std::vector<double>(count, turn));
}

class LoneLeaderTest : public ::testing::Test {
 protected:
  // The pair of a captured sequence whose two people stand, 1.2 m apart, with the leader given.
  dataset::Sequence Replaced(const Poses& leader, uint64_t seed = 1) {
    dataset_.lone_leaders = {{"made", leader}};
    dataset::Sequence sequence = Captured();
    base::Random random(seed);
    const checkpoint::Manifest manifest = ManifestFor(options_, dataset_);
    ReplaceLeader(manifest.model, dataset_, augmentation_, &random, &sequence);
    return sequence;
  }
  dataset::Sequence Captured() const {
    dataset::Sequence sequence = dataset_.sequences[6];  // the longest
    const int frames = sequence.pair.leader.frame_count();
    sequence.pair.leader.poses = StandingAt(frames, {}, 0);
    sequence.pair.follower.poses = StandingAt(frames, {0, 0, -1.2f}, base::kPi);
    sequence.partner_direction = Vec3{0, 0, -1};
    return sequence;
  }
  Vec3 Root(const motion::Clip& clip, int frame) const {
    Vec3 root = clip.at(frame, dataset_.skeleton.root);
    root.y = 0;
    return root;
  }

  dataset::Dataset dataset_ = MadeUpDataset();
  TrainingOptions options_ = SmallFlowOptions();
  TrainingOptions::Augmentation augmentation_;
};

TEST_F(LoneLeaderTest, FollowerStandsBeforeALeaderElsewhereAsBeforeItsOwn) {
  const double turn = 2;
  const dataset::Sequence pair = Replaced(StandingAt(40, {5, 0, -3}, turn));
  EXPECT_EQ(pair.pair.leader.frame_count(), Captured().pair.leader.frame_count());
  const Vec3 ahead = RotateY(Vec3{0, 0, -1}, turn);
  for (int t = 0; t < pair.pair.leader.frame_count(); ++t) {
    const Vec3 apart = Root(pair.pair.follower, t) - Root(pair.pair.leader, t);
    EXPECT_LT(Distance(apart, ahead * 1.2f), 0.05f) << t;
    const Vec3 right = pair.pair.follower.at(t, dataset_.skeleton.hips->right) -
                       pair.pair.follower.at(t, dataset_.skeleton.hips->left);
    const Vec3 facing = Cross({0, 1, 0}, right);
    EXPECT_LT(Dot(facing, ahead), 0) << t;  // towards the leader
  }
  EXPECT_LT(Distance(*pair.partner_direction, ahead), 0.05f);
  EXPECT_EQ(pair.interaction_class, Captured().interaction_class);
}

TEST_F(LoneLeaderTest, FollowerKeepsItsDistanceAndStepsWhenTheLeaderWalks) {
  std::vector<Vec3> places;
  for (int t = 0; t < 60; ++t) places.push_back({static_cast<float>(0.8 * t / kRate), 0, 0});
  const dataset::Sequence pair = Replaced(Standing(60, places, std::vector<double>(60, 0)));
  const motion::Clip& follower = pair.pair.follower;
  const int last = follower.frame_count() - 1;
  EXPECT_NEAR(Distance(Root(follower, last), Root(pair.pair.leader, last)), 1.2, 0.15);
  EXPECT_GT(Distance(Root(follower, last), Root(follower, 0)), 0.5);
  int standing = 0;
  for (int t = 1; t <= last; ++t) {
    const auto speed = [&](int foot) {
      return Distance(follower.at(t, foot), follower.at(t - 1, foot)) * kRate;
    };
    standing +=
        std::min(speed(dataset_.skeleton.feet->left), speed(dataset_.skeleton.feet->right)) < 0.2;
  }
  EXPECT_GT(standing, last / 2);  // a follower that is only carried along would slide at 0.8 m/s
}

TEST_F(LoneLeaderTest, FollowerDoesNotOrbitALeaderWhoSpins) {
  std::vector<double> turns;
  for (int t = 0; t < 60; ++t) turns.push_back(6.0 * t / kRate);
  const dataset::Sequence pair =
      Replaced(Standing(60, std::vector<Vec3>(60, Vec3{}), turns), /*seed=*/3);
  const motion::Clip& follower = pair.pair.follower;
  double fastest = 0;
  for (int t = 1; t < follower.frame_count(); ++t) {
    fastest = std::max(fastest, kRate * Distance(Root(follower, t), Root(follower, t - 1)));
    EXPECT_NEAR(Distance(Root(follower, t), Root(pair.pair.leader, t)), 1.2, 0.15) << t;
  }
  EXPECT_LT(fastest, 1.2);  // with the leader it would be 7 m/s
}

// The follower walks away from its leader, by 0.6 m, and gets one who stands.
TEST_F(LoneLeaderTest, FollowerOfARestingLeaderGoesBackUnlessItsLabelsHaveTimes) {
  const auto last_distance = [this](const std::vector<dataset::LabelSpan>& labels) {
    double most = 0;
    for (uint64_t seed = 0; seed < 20; ++seed) {
      dataset_.lone_leaders = {{"made", StandingAt(40, {}, 0)}};
      dataset::Sequence sequence = Captured();
      sequence.labels = labels;
      motion::Clip& walking = sequence.pair.follower;
      const int last = walking.frame_count() - 1;
      for (int t = 0; t <= last; ++t) {
        for (Vec3& joint : walking.poses[t]) joint.z -= 0.6f * static_cast<float>(t) / last;
      }
      base::Random random(seed);
      const checkpoint::Manifest manifest = ManifestFor(options_, dataset_);
      ReplaceLeader(manifest.model, dataset_, augmentation_, &random, &sequence);
      const double apart = Distance(Root(walking, last), Root(sequence.pair.leader, last));
      most = std::max(most, apart);
    }
    return most;
  };
  EXPECT_LT(last_distance({}), 1.65);  // it may have begun at the farthest place, and sway
  EXPECT_GT(last_distance({{0, 0, 18}}), 1.7);
}

TEST_F(LoneLeaderTest, ALeaderThatIsShorterThanTheClipIsNotUsed) {
  const dataset::Sequence captured = Captured();
  const int frames = captured.pair.leader.frame_count();
  const dataset::Sequence pair = Replaced(StandingAt(frames - 1, {5, 0, 0}, 1));
  EXPECT_EQ(pair.pair.leader.poses, captured.pair.leader.poses);
  EXPECT_EQ(pair.pair.follower.poses, captured.pair.follower.poses);
}

TEST_F(LoneLeaderTest, LeadersAndOptionsMustFit) {
  const auto refusal = [this] {
    return std::string(CheckLoneLeaders(options_, dataset_).message());
  };
  EXPECT_EQ(refusal(), "");
  FlowOf(&options_).leaders.share = 0.25;
  EXPECT_EQ(refusal(),
            "leaders.share: expected 0 without motions of leaders (--leaders), got 0.25");
  dataset_.lone_leaders = {{"short", StandingAt(9, {}, 0)}};
  EXPECT_EQ(refusal(),
            "leaders: expected a motion of at least 1.20 s, as long as the longest clip of the "
            "data, got at most 0.60 s");
  dataset_.lone_leaders.push_back({"long", StandingAt(30, {}, 0)});
  EXPECT_EQ(refusal(), "");
  dataset_.skeleton.hips.reset();
  EXPECT_THAT(refusal(), HasSubstr("expected a skeleton with hips"));
  dataset_.skeleton = motion::SbuSkeleton();
  FlowOf(&options_).leaders.share = 0;
  EXPECT_THAT(refusal(), HasSubstr("leaders.share: expected a share above 0"));
  options_ = SmallOptions();  // the paper's generator
  EXPECT_THAT(refusal(), HasSubstr("of a sampling generator"));
}

constexpr int kReactionFrames = 45;

std::vector<double> Reached(const std::vector<double>& acting, uint64_t seed) {
  base::Random random(seed);
  return ReactionFrames(acting, 0, kReactionFrames, kRate, &random);
}

TEST(ReactionPaceTest, BesideALeaderWhoRestsTheFollowerGoesBackAndSways) {
  const std::vector<double> resting(150, 0);
  int recovered = 0;
  for (uint64_t seed = 0; seed < 40; ++seed) {
    base::Random random(seed);
    const std::vector<double> reached = ReactionFrames(resting, 0, 150, kRate, &random);
    for (size_t t = 1; t < reached.size(); ++t) {
      const double before = reached[t - 1];
      EXPECT_TRUE(before <= 6.7 || std::abs(reached[t] - before + 0.7) < 1e-9) << seed << ' ' << t;
    }
    if (reached.front() > 6 && reached.front() < 60) {
      ++recovered;
      EXPECT_LE(reached.back(), 6);
    }
    if (reached.front() <= 6) {
      const auto [least, most] = std::minmax_element(reached.begin(), reached.end());
      EXPECT_NEAR(*least, 0, 0.1);
      EXPECT_NEAR(*most, 6, 0.1);  // 0.4 s
    }
  }
  EXPECT_GT(recovered, 3);
}

TEST(ReactionPaceTest, AfterItsEndAReactionGoesBackAndComesAgain) {
  const std::vector<double> acting(200, 1);
  base::Random random(1);
  const std::vector<double> reached = ReactionFrames(acting, 20, 180, kRate, &random);
  EXPECT_THAT(reached, testing::Each(testing::Ge(0)));
  EXPECT_THAT(reached, testing::Each(testing::Le(179)));
  std::vector<double> early = Reached(acting, 1);
  EXPECT_LE(*std::max_element(early.begin(), early.end()), kReactionFrames - 1);
  for (uint64_t seed = 0; seed < 40; ++seed) {
    early = Reached(acting, seed);
    if (early.front() < kReactionFrames / 2.0) continue;
    EXPECT_LT(early.back(), kReactionFrames - 1.5) << seed;  // on its way back
  }
}

}  // namespace
}  // namespace duet::training

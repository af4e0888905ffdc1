#include <gmock/gmock.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "model/body/build.h"
#include "model/body/limbs.h"
#include "model/motion/limb_lengths.h"
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
constexpr int kMost = 46, kCaptured = 24;

// A leader who stands and then reaches out, and a follower a metre away who steps back by 0.4 m.
dataset::Sequence Reaction() {
  dataset::Sequence sequence;
  sequence.interaction_class = 1;
  motion::Clip& leader = sequence.pair.leader;
  leader.joint_names = motion::SbuSkeleton().joint_names;
  leader.frame_rate_hz = kRate;
  leader.poses = test::SteppingMotion({}, kCaptured, kRate);
  sequence.pair.follower = leader;
  const int hand = body::FindBody(motion::SbuSkeleton()).arms.front().end;
  for (int t = 0; t < kCaptured; ++t) {
    const float share = std::clamp((static_cast<float>(t) - 6) / 10, 0.0f, 1.0f);
    leader.at(t, hand) += Vec3{0, 0.4f, -0.3f} * share;
    for (Vec3& joint : sequence.pair.follower.poses[t]) joint.z -= 1 + 0.4f * share;
  }
  return sequence;
}

FlowSettings::Stillness Only(const std::string& share) {
  return Settings<FlowSettings::Stillness>(share + ": 1");
}

StillClip Draw(const FlowSettings::Stillness& options, uint64_t seed) {
  base::Random random(seed);
  return AddStillness(motion::SbuSkeleton(), options, kRate, kMost, &random, Reaction());
}

// How far any joint moves between two frames at most.
double Moved(const Poses& poses, int from, int to) {
  double most = 0;
  for (int j = 0; j < poses.joint_count(); ++j) {
    most = std::max<double>(most, Distance(poses.at(from, j), poses.at(to, j)));
  }
  return most;
}
double FastestJoint(const Poses& poses) {
  double most = 0;
  for (int t = 1; t < poses.frame_count(); ++t) most = std::max(most, Moved(poses, t - 1, t));
  return most * kRate;
}
// The captured frame that a pose equals; -1 if there is none.
int FrameOf(const Poses& captured, const Poses& poses, int frame) {
  for (int t = 0; t < captured.frame_count(); ++t) {
    if (captured[t] == poses[frame]) return t;
  }
  return -1;
}
double Distance(const StillClip& clip, int frame) {
  const motion::ClipPair& pair = clip.sequence.pair;
  const int root = motion::SbuSkeleton().root;
  return Norm(pair.follower.at(frame, root) - pair.leader.at(frame, root));
}

TEST(StillnessTest, ClipsAreAtMostAsLongAsAWindowAndBonesKeepTheirLengths) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  const auto options =
      Settings<FlowSettings::Stillness>("pauses: 1 ends: 0.25 motionless: 0.25 unlabelled: 0.25");
  const dataset::Sequence captured = Reaction();
  const std::vector<float> lengths = MedianBoneLengths(skeleton, captured.pair.follower.poses);
  for (uint64_t seed = 0; seed < 100; ++seed) {
    const motion::ClipPair pair = Draw(options, seed).sequence.pair;
    EXPECT_LE(pair.leader.frame_count(), kMost);
    EXPECT_EQ(pair.leader.frame_count(), pair.follower.frame_count());
    EXPECT_LT(FastestJoint(pair.follower.poses), 3) << seed;  // a step, no jump
    for (int t = 0; t < pair.follower.frame_count(); ++t) {
      for (size_t b = 0; b < lengths.size(); ++b) {
        const motion::Bone& bone = skeleton.bones[b];
        EXPECT_NEAR(
            motion::Distance(pair.follower.at(t, bone.parent), pair.follower.at(t, bone.child)),
            lengths[b], 0.02f)
            << seed << ' ' << t << ' ' << b;
      }
    }
  }
}

TEST(StillnessTest, PausesSurroundTheWholeReaction) {
  const dataset::Sequence captured = Reaction();
  int before = 0, after = 0, whole = 0;
  for (uint64_t seed = 0; seed < 100; ++seed) {
    const StillClip clip = Draw(Only("pauses"), seed);
    EXPECT_FALSE(clip.amid);
    EXPECT_FALSE(clip.unlabelled);
    const Poses& follower = clip.sequence.pair.follower.poses;
    const int first = FrameOf(captured.pair.follower.poses, follower, 0);
    before += first < 0;
    after += Moved(follower, follower.frame_count() - 2, follower.frame_count() - 1) > 0 ||
             follower.frame_count() > 34;
    // The reaction of 0.4 m is there.
    double farthest = 0;
    for (int t = 0; t < follower.frame_count(); ++t) {
      farthest = std::max(farthest, Distance(clip, t));
    }
    whole += farthest > 1.35;
  }
  EXPECT_NEAR(before, 60, 15);
  EXPECT_GT(after, 60);
  EXPECT_EQ(whole, 100);
}

TEST(StillnessTest, BesideALeaderWhoDoesNotMoveTheFollowerStands) {
  int midst = 0;
  for (uint64_t seed = 0; seed < 60; ++seed) {
    const StillClip clip = Draw(Only("motionless"), seed);
    const motion::ClipPair& pair = clip.sequence.pair;
    EXPECT_FALSE(clip.unlabelled);
    EXPECT_LT(FastestJoint(pair.leader.poses), 0.15);
    if (clip.amid) {
      ++midst;
      continue;
    }
    EXPECT_LT(FastestJoint(pair.follower.poses), 0.15) << seed;
    EXPECT_NEAR(Distance(clip, 0), 1, 0.1);
    const body::StillnessFigures figures = MeasureStillness(
        motion::SbuSkeleton(), body::FindBody(motion::SbuSkeleton()), pair.follower.poses, kRate);
    EXPECT_LT(figures.joint_speed, 0.1);
    EXPECT_EQ(figures.hand_over_shoulder, 0);
  }
  EXPECT_NEAR(midst, 30, 12);
}

TEST(StillnessTest, AFollowerInTheMidstGoesToRestInOneStepOfEachFoot) {
  const motion::JointPair feet = *motion::SbuSkeleton().feet;
  int returned = 0;
  for (uint64_t seed = 0; seed < 300; ++seed) {
    const StillClip clip = Draw(Only("motionless"), seed);
    const Poses& follower = clip.sequence.pair.follower.poses;
    const int last = follower.frame_count() - 1;
    if (!clip.amid || Distance(clip, 0) < 1.3 || last < 38) continue;
    ++returned;
    EXPECT_NEAR(Distance(clip, last), 1, 0.1) << seed;
    // One foot at a time.
    for (int t = 12; t <= last; ++t) {
      const auto step = [&](int foot) {
        return motion::Distance(follower.at(t, foot), follower.at(t - 1, foot));
      };
      EXPECT_LT(std::min(step(feet.left), step(feet.right)), 0.02f) << seed << ' ' << t;
    }
  }
  EXPECT_GT(returned, 3);
}

TEST(StillnessTest, WithoutALabelTheFollowerRestsWhateverTheLeaderDoes) {
  const int hand = body::FindBody(motion::SbuSkeleton()).arms.front().end;
  int acting = 0, resting = 0;
  for (uint64_t seed = 0; seed < 60; ++seed) {
    const StillClip clip = Draw(Only("unlabelled"), seed);
    EXPECT_TRUE(clip.unlabelled);
    if (clip.amid) continue;
    const motion::ClipPair& pair = clip.sequence.pair;
    float lowest = 9, highest = 0;
    for (int t = 0; t < pair.leader.frame_count(); ++t) {
      lowest = std::min(lowest, pair.leader.at(t, hand).y);
      highest = std::max(highest, pair.leader.at(t, hand).y);
    }
    acting += highest - lowest > 0.3f;
    resting += FastestJoint(pair.follower.poses) < 0.15;
  }
  EXPECT_GT(acting, 15);
  EXPECT_EQ(acting, resting);
}

TEST(StillnessTest, AnEndBeginsInTheReactionAndRests) {
  for (uint64_t seed = 0; seed < 40; ++seed) {
    const StillClip clip = Draw(Only("ends"), seed);
    EXPECT_TRUE(clip.amid);
    const Poses& follower = clip.sequence.pair.follower.poses;
    EXPECT_GE(FrameOf(Reaction().pair.follower.poses, follower, 0), kCaptured / 2) << seed;
    if (follower.frame_count() < kMost) continue;
    EXPECT_NEAR(Distance(clip, follower.frame_count() - 1), 1, 0.15) << seed;
  }
}

TEST(StillnessTest, SkeletonAndOptionsMustFit) {
  dataset::Dataset dataset = MadeUpDataset();
  TrainingOptions options = SmallFlowOptions();
  options.flow.mutable_stillness()->set_motionless(0.2);
  EXPECT_THAT(CheckStillness(options, dataset), IsOk());
  FlowOf(&options).frame_labels = true;
  EXPECT_THAT(std::string(CheckStillness(options, dataset).message()), HasSubstr("frame_labels"));
  FlowOf(&options).frame_labels = false;
  dataset.skeleton.hips.reset();
  EXPECT_THAT(std::string(CheckStillness(options, dataset).message()), HasSubstr("with hips"));
  options.flow.mutable_stillness()->set_motionless(0);
  EXPECT_THAT(CheckStillness(options, dataset), IsOk());
}

}  // namespace
}  // namespace duet::training

#include <gtest/gtest.h>

#include <cmath>

#include "model/dataset/dataset.h"
#include "model/motion/posture.h"
#include "tests/support/sample_motion.h"

namespace duet::dataset {
namespace {

constexpr int kFrames = 40;

// A person of made-up motion who stands at `x`.
motion::Clip Person(float x) {
  motion::Clip clip;
  clip.joint_names = motion::SbuSkeleton().joint_names;
  clip.frame_rate_hz = 15;
  clip.poses = test::SwayingMotion(kFrames, clip.frame_rate_hz);
  for (motion::Vec3& point : clip.poses.all()) point.x += x;
  return clip;
}

// Sequences of upright people, `count` of them in a set.
Dataset Upright(int count, const std::string& set = "") {
  Dataset dataset;
  dataset.skeleton = motion::SbuSkeleton();
  for (int i = 0; i < count; ++i) {
    Sequence sequence;
    sequence.set = set;
    sequence.pair = {Person(-0.6f), Person(0.6f)};
    dataset.sequences.push_back(sequence);
  }
  return dataset;
}

// The same as a camera sees it that is turned and hangs above the floor.
void Capture(const motion::Levelling& camera, Dataset* dataset) {
  for (Sequence& sequence : dataset->sequences) {
    sequence.pair.leader.poses = camera.Invert(sequence.pair.leader.poses);
    sequence.pair.follower.poses = camera.Invert(sequence.pair.follower.poses);
  }
}

// The vertical that leans by these angles towards +x and +z.
motion::Vec3 Up(double x_degrees, double z_degrees) {
  return {static_cast<float>(std::tan(x_degrees * M_PI / 180)), 1,
          static_cast<float>(std::tan(z_degrees * M_PI / 180))};
}

double LargestDistance(const motion::Poses& a, const motion::Poses& b) {
  double largest = 0;
  for (int t = 0; t < a.frame_count(); ++t) {
    for (int j = 0; j < a.joint_count(); ++j) {
      largest = std::max<double>(largest, Distance(a.at(t, j), b.at(t, j)));
    }
  }
  return largest;
}

motion::Lean LeanOfLeader(const Dataset& dataset, size_t sequence) {
  return MeanLean(
      StandingDirections(dataset.skeleton, dataset.sequences[sequence].pair.leader.poses));
}

TEST(LevelSetsTest, FindsTheTiltAndTheFloor) {
  Dataset level = Upright(3);
  LevelSets(&level);  // these people sway, too
  Dataset tilted = Upright(3);
  Capture(motion::Levelling(Up(2, 9), 0.9f), &tilted);
  EXPECT_NEAR(LeanOfLeader(tilted, 0).z, 9, 1);
  LevelSets(&tilted);
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_LT(LargestDistance(tilted.sequences[i].pair.leader.poses,
                              level.sequences[i].pair.leader.poses),
              0.02);
    EXPECT_LT(LargestDistance(tilted.sequences[i].pair.follower.poses,
                              level.sequences[i].pair.follower.poses),
              0.02);
  }
  EXPECT_NEAR(LeanOf(tilted.sequences[0].levelling.up()).z, 9, 0.5);
  EXPECT_NEAR(LeanOf(tilted.sequences[0].levelling.up()).x, 2, 0.5);
}

TEST(LevelSetsTest, TheCapturedWorldComesBackExactly) {
  Dataset tilted = Upright(2);
  Capture(motion::Levelling(Up(-3, 7), 1.1f), &tilted);
  const motion::Poses captured = tilted.sequences[1].pair.follower.poses;
  LevelSets(&tilted);
  const Sequence& sequence = tilted.sequences[1];
  EXPECT_GT(LargestDistance(sequence.pair.follower.poses, captured), 0.1);
  EXPECT_LT(LargestDistance(sequence.levelling.Invert(sequence.pair.follower.poses), captured),
            1e-5);
}

TEST(LevelSetsTest, SomebodyWhoBowsHardlyPulls) {
  Dataset dataset = Upright(4);
  Dataset bowing = dataset;
  const int neck = dataset.skeleton.Find("neck");
  // One of eight people bows by some 40 degrees all the time.
  for (int t = 0; t < kFrames; ++t) {
    bowing.sequences[0].pair.leader.at(t, neck) += motion::Vec3{0, -0.4f, 1.0f};
  }
  LevelSets(&dataset);
  LevelSets(&bowing);
  const motion::Lean without = LeanOf(dataset.sequences[0].levelling.up());
  const motion::Lean with = LeanOf(bowing.sequences[0].levelling.up());
  EXPECT_NEAR(with.z, without.z, 1);  // the mean would move by 5
}

TEST(LevelSetsTest, EachSetHasItsOwnCamera) {
  Dataset dataset = Upright(40, "a");
  Dataset other = Upright(40, "b");
  Capture(motion::Levelling(Up(0, 5), 0.5f), &dataset);
  Capture(motion::Levelling(Up(0, 11), 0.9f), &other);
  dataset.sequences.insert(dataset.sequences.end(), other.sequences.begin(), other.sequences.end());
  LevelSets(&dataset);
  // Both are drawn a little towards their common 8 degrees.
  EXPECT_NEAR(LeanOf(dataset.sequences[0].levelling.up()).z, 5.2, 0.5);
  EXPECT_NEAR(LeanOf(dataset.sequences[79].levelling.up()).z, 10.8, 0.5);
  EXPECT_NEAR(dataset.sequences[79].levelling.floor_height() -
                  dataset.sequences[0].levelling.floor_height(),
              0.4, 0.02);
}

void ExpectUnchanged(Dataset dataset) {
  const Dataset before = dataset;
  LevelSets(&dataset);
  for (size_t i = 0; i < dataset.sequences.size(); ++i) {
    EXPECT_EQ(dataset.sequences[i].pair.leader.poses, before.sequences[i].pair.leader.poses);
    EXPECT_EQ(dataset.sequences[i].levelling.up(), (motion::Vec3{0, 1, 0}));
    EXPECT_EQ(dataset.sequences[i].levelling.floor_height(), 0);
  }
}

TEST(LevelSetsTest, SixtyPosesAreEnough) {
  Dataset dataset = Upright(1);
  Capture(motion::Levelling(Up(0, 9), 0.5f), &dataset);
  for (motion::Clip* clip :
       {&dataset.sequences[0].pair.leader, &dataset.sequences[0].pair.follower}) {
    clip->poses.Resize(30);
  }
  LevelSets(&dataset);
  EXPECT_NE(dataset.sequences[0].levelling.floor_height(), 0);
}

TEST(LevelSetsTest, PeopleWithoutFeetStay) {
  Dataset dataset = Upright(3);
  Capture(motion::Levelling(Up(0, 9), 0.5f), &dataset);
  dataset.skeleton.feet.reset();
  ExpectUnchanged(dataset);
}

}  // namespace
}  // namespace duet::dataset

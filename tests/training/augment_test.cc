#include "model/training/augment.h"

#include <gmock/gmock.h>

#include "tests/training/made_up_dataset.h"

namespace duet::training {
namespace {

double LengthOfBone(const motion::Clip& clip, int frame, const motion::Bone& bone) {
  return Distance(clip.at(frame, bone.parent), clip.at(frame, bone.child));
}

TEST(MirrorTest, ExchangesSidesAndIsItsOwnInverse) {
  const dataset::Dataset dataset = MadeUpDataset();
  const motion::Skeleton& skeleton = dataset.skeleton;
  dataset::Sequence mirrored = dataset.sequences[0];
  mirrored.partner_direction = motion::Vec3{1, 0, 0};
  const motion::Vec3 left_hand = mirrored.pair.leader.at(3, skeleton.Find("left_hand"));
  Mirror(MirroredJoints(skeleton), &mirrored);
  EXPECT_EQ(mirrored.pair.leader.at(3, skeleton.Find("right_hand")),
            (motion::Vec3{-left_hand.x, left_hand.y, left_hand.z}));
  EXPECT_EQ(*mirrored.partner_direction, (motion::Vec3{-1, 0, 0}));
  Mirror(MirroredJoints(skeleton), &mirrored);
  EXPECT_EQ(mirrored.pair.leader.poses, dataset.sequences[0].pair.leader.poses);
  EXPECT_EQ(mirrored.pair.follower.poses, dataset.sequences[0].pair.follower.poses);
}

dataset::Sequence AugmentedBy(const CommonSettings::Augmentation& options, int index) {
  const dataset::Dataset dataset = MadeUpDataset();
  base::Random random(3, 1);
  return Augment(dataset, dataset.sequences[static_cast<size_t>(index)], options, &random);
}

TEST(AugmentTest, SwapsRolesOnlyInSymmetricClasses) {
  CommonSettings::Augmentation options;
  options.set_swap_roles(1);
  const dataset::Dataset dataset = MadeUpDataset();
  EXPECT_EQ(AugmentedBy(options, 1).pair.leader.poses, dataset.sequences[1].pair.follower.poses);
  EXPECT_EQ(AugmentedBy(options, 0).pair.leader.poses, dataset.sequences[0].pair.leader.poses);
}

TEST(AugmentTest, MirrorsNoHandedClass) {
  const dataset::Dataset dataset = MadeUpDataset();
  ASSERT_EQ(dataset.handed, (std::vector<bool>{false, true, true}));
  const auto is_mirrored = [&](const CommonSettings::Augmentation& options, int index) {
    const motion::Poses& before = dataset.sequences[static_cast<size_t>(index)].pair.leader.poses;
    return AugmentedBy(options, index).pair.leader.poses != before;
  };
  CommonSettings::Augmentation options;
  options.set_mirror(1);
  EXPECT_TRUE(is_mirrored(options, 0));
  EXPECT_FALSE(is_mirrored(options, 2));
}

TEST(AugmentTest, BodyScaleKeepsProportionsOfEachPerson) {
  CommonSettings::Augmentation options;
  options.set_body_scale(0.2);
  const dataset::Sequence before = MadeUpDataset().sequences[0], after = AugmentedBy(options, 0);
  const std::vector<motion::Bone> bones = motion::SbuSkeleton().bones;
  const double scale = LengthOfBone(after.pair.follower, 0, bones[0]) /
                       LengthOfBone(before.pair.follower, 0, bones[0]);
  EXPECT_GT(std::abs(scale - 1), 1e-3);
  EXPECT_LE(std::abs(scale - 1), 0.2 + 1e-5);
  for (const motion::Bone& bone : bones) {
    EXPECT_NEAR(
        LengthOfBone(after.pair.follower, 5, bone) / LengthOfBone(before.pair.follower, 5, bone),
        scale, 1e-4);
  }
}

TEST(AugmentTest, CropKeepsTheSamePartOfBothPeople) {
  CommonSettings::Augmentation options;
  options.set_crop(1);
  const dataset::Sequence before = MadeUpDataset().sequences[6], after = AugmentedBy(options, 6);
  const int frames = after.pair.leader.frame_count();
  EXPECT_EQ(after.pair.follower.frame_count(), frames);
  EXPECT_LT(frames, before.pair.leader.frame_count());
  EXPECT_GE(frames, 10);
  int first = 0;
  while (before.pair.leader.at(first, 0) != after.pair.leader.at(0, 0)) ++first;
  EXPECT_EQ(after.pair.follower.at(0, 4), before.pair.follower.at(first, 4));
}

TEST(AugmentTest, CropAndWarpMoveTheTimeLine) {
  const dataset::Dataset dataset = MadeUpDataset();
  dataset::Sequence before = dataset.sequences[6];
  const int frames = before.pair.leader.frame_count();
  before.labels = {{1, 0, 3}};
  CommonSettings::Augmentation options;
  options.set_crop(1);
  base::Random random(3, 1);
  bool cropped = false;
  for (int draw = 0; draw < 50; ++draw) {
    const dataset::Sequence after = Augment(dataset, before, options, &random);
    // A crop that would lose every class is not made.
    ASSERT_EQ(after.labels.size(), 1u);
    EXPECT_EQ(after.labels[0].begin, 0);
    EXPECT_LE(after.labels[0].end, 3);
    cropped = cropped || after.pair.leader.frame_count() < frames;
  }
  EXPECT_TRUE(cropped);

  before.labels = {{1, frames / 2, frames}};
  options.set_crop(0);
  options.set_time_warp(0.5);
  bool is_warped = false;
  for (int draw = 0; draw < 20; ++draw) {
    const dataset::Sequence after = Augment(dataset, before, options, &random);
    const int warped = after.pair.leader.frame_count();
    is_warped = is_warped || warped != frames;
    EXPECT_EQ(after.labels[0].begin, frames / 2 * warped / frames);
    EXPECT_EQ(after.labels[0].end, warped);
  }
  EXPECT_TRUE(is_warped);
}

TEST(AugmentTest, TimeWarpKeepsBothEnds) {
  CommonSettings::Augmentation options;
  options.set_time_warp(0.5);
  const dataset::Sequence before = MadeUpDataset().sequences[0], after = AugmentedBy(options, 0);
  EXPECT_NE(after.pair.leader.frame_count(), before.pair.leader.frame_count());
  EXPECT_EQ(after.pair.leader.frame_count(), after.pair.follower.frame_count());
  EXPECT_EQ(after.pair.leader.at(0, 3), before.pair.leader.at(0, 3));
  EXPECT_LT(Distance(after.pair.leader.at(after.pair.leader.frame_count() - 1, 3),
                     before.pair.leader.at(before.pair.leader.frame_count() - 1, 3)),
            1e-5);
}

}  // namespace
}  // namespace duet::training

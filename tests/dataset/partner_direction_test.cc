#include "model/dataset/partner_direction.h"

#include <gtest/gtest.h>

namespace duet::dataset {
namespace {

TEST(PartnerDirection, IsFromRootToRootUnlessTheSetupTells) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  Sequence sequence;
  sequence.pair.leader.poses = sequence.pair.follower.poses = motion::Poses(2, 15);
  sequence.pair.leader.poses.at(0, skeleton.root) = {1, 1, 2};
  sequence.pair.follower.poses.at(0, skeleton.root) = {4, 1.5f, -2};
  sequence.pair.follower.poses.at(1, skeleton.root) = {9, 9, 9};
  EXPECT_EQ(PartnerDirection(skeleton, sequence), (motion::Vec3{3, 0, -4}));
  sequence.partner_direction = motion::Vec3{-1, 0, 0};
  EXPECT_EQ(PartnerDirection(skeleton, sequence), (motion::Vec3{-1, 0, 0}));
}

}  // namespace
}  // namespace duet::dataset

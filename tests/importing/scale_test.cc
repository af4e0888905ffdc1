#include "model/importing/scale.h"

#include <gmock/gmock.h>

#include "tests/support/test_motion.h"

namespace duet::importing {
namespace {

TEST(FindUnitTest, IsTheOneInWhichMostLegsAreAPersons) {
  EXPECT_EQ(FindUnit({0.9})->metres, 1);
  EXPECT_EQ(FindUnit({92, 88, 3})->name, "centimetres");
  EXPECT_EQ(FindUnit({890, 910})->metres, 0.001);
  EXPECT_EQ(FindUnit({36})->name, "inches");
  EXPECT_FALSE(FindUnit({4}).has_value());
}

TEST(LegLengthTest, FollowsTheBonesFromBothFeet) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  motion::Poses poses(1, 15);
  for (const char* name : {"left_hip", "left_knee", "left_foot"}) {
    poses.at(0, skeleton.Find(name)).x = 1;
  }
  poses.at(0, skeleton.Find("left_foot")).y = -2;
  EXPECT_DOUBLE_EQ(LegLength(skeleton, poses), 1.5);  // 1 + 2 and nothing
}

TEST(FindUpAxisTest, IsTheOneThatPeopleStandAlong) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  const motion::Poses upright = test::MakePerson().poses;
  const auto turned = [&](motion::Vec3 (*turn)(motion::Vec3)) {
    motion::Poses poses = upright;
    for (motion::Vec3& point : poses.all()) point = turn(point);
    return FindUpAxis(skeleton, {&upright, &poses, &poses});
  };
  using motion::Vec3;
  EXPECT_EQ(turned([](Vec3 p) { return p; }), motion::UpAxis::kYUp);
  EXPECT_EQ(turned([](Vec3 p) { return Vec3{p.x, -p.z, p.y}; }), motion::UpAxis::kZUp);
  EXPECT_EQ(turned([](Vec3 p) { return Vec3{p.x, -2 * p.y, -p.z}; }), motion::UpAxis::kYDown);
  EXPECT_EQ(turned([](Vec3 p) { return Vec3{p.y, -p.x, p.z}; }), std::nullopt);
}

}  // namespace
}  // namespace duet::importing

#include "model/motion/inferred_coordinates.h"

#include <gmock/gmock.h>

#include <cmath>
#include <string>

#include "tests/support/test_motion.h"

namespace duet::motion {
namespace {

TEST(LegLength, IsTheMeanOfBothLegs) {
  const Skeleton skeleton = SbuSkeleton();
  Poses poses(1, 15);
  for (const char* name : {"left_hip", "left_knee", "left_foot"}) {
    poses.at(0, skeleton.Find(name)).x = 1;
  }
  poses.at(0, skeleton.Find("left_foot")).y = -2;
  EXPECT_DOUBLE_EQ(LegLength(skeleton, poses), 1.5);  // left 1 + 2, right 0
}

TEST(InferUnit, IsTheOneInWhichTheMedianLegIsAPersons) {
  EXPECT_EQ(InferUnit({0.9})->metres, 1);
  EXPECT_STREQ(InferUnit({92, 88, 3})->name, "centimetres");
  EXPECT_EQ(InferUnit({890, 910})->metres, 0.001);
  EXPECT_STREQ(InferUnit({36})->name, "inches");
  EXPECT_STREQ(InferUnit({16})->name, "CMU's unit (0.45 to the inch)");
  EXPECT_STREQ(InferUnit({9})->name, "decimetres");
  EXPECT_FALSE(InferUnit({4}).has_value());
}

TEST(InferUnit, PrefersCmusUnitToDecimetres) {
  EXPECT_STREQ(InferUnit({12.3})->name, "decimetres");
  EXPECT_STREQ(InferUnit({13})->name, "CMU's unit (0.45 to the inch)");
}

class InferUpAxisTest : public ::testing::Test {
 protected:
  // Of two people who are turned and one who stands upright.
  std::optional<UpAxis> Turned(Vec3 (*turn)(Vec3)) const {
    Poses poses = upright_;
    for (Vec3& point : poses.all()) point = turn(point);
    return InferUpAxis(skeleton_, {&upright_, &poses, &poses});
  }

  Skeleton skeleton_ = SbuSkeleton();
  const Poses upright_ = test::MakePerson().poses;
};

TEST_F(InferUpAxisTest, IsTheOneThatMostPeopleStandAlong) {
  EXPECT_EQ(Turned([](Vec3 p) { return p; }), UpAxis::kYUp);
  EXPECT_EQ(Turned([](Vec3 p) { return Vec3{p.x, -p.z, p.y}; }), UpAxis::kZUp);
  EXPECT_EQ(Turned([](Vec3 p) { return Vec3{p.x, -2 * p.y, -p.z}; }), UpAxis::kYDown);
}

TEST_F(InferUpAxisTest, IsAbsentForAnAxisThatCoordinatesLack) {
  EXPECT_EQ(Turned([](Vec3 p) { return Vec3{p.y, -p.x, p.z}; }), std::nullopt);
  EXPECT_EQ(Turned([](Vec3 p) { return Vec3{-p.y, p.x, p.z}; }), std::nullopt);
  EXPECT_EQ(Turned([](Vec3 p) { return Vec3{p.x, p.z, -p.y}; }), std::nullopt);
}

TEST_F(InferUpAxisTest, IsAbsentWithoutFeetOrDirection) {
  const Poses point(3, 15);
  EXPECT_EQ(InferUpAxis(skeleton_, {&point}), std::nullopt);
  skeleton_.feet.reset();
  EXPECT_EQ(InferUpAxis(skeleton_, {&upright_}), std::nullopt);
}

}  // namespace
}  // namespace duet::motion

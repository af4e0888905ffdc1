#include "model/formats/asf/amc_motion.h"

#include <string>
#include <vector>

#include "absl/strings/str_replace.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/expect_near.h"
#include "tests/support/matchers.h"

namespace duet::formats::asf {
namespace {

using retargeting::Vec3d;

// A root, an arm along x that turns about axes of its own (its x is the world's y), a stiff hand.
AsfSkeleton Arm() {
  AsfSkeleton skeleton;
  skeleton.position = {0, 0, 100};
  skeleton.bones.resize(3);
  skeleton.bones[0].name = "root";
  skeleton.bones[0].freedoms = {AsfFreedom::kTx, AsfFreedom::kTy, AsfFreedom::kTz, AsfFreedom::kRz,
                                AsfFreedom::kRx};
  skeleton.bones[1].name = "arm";
  skeleton.bones[1].parent = 0;
  skeleton.bones[1].extent = {10, 0, 0};
  skeleton.bones[1].axes = retargeting::AxisAngle({0, 0, 1}, 1.5707963267948966);
  skeleton.bones[1].freedoms = {AsfFreedom::kRx};
  skeleton.bones[2].name = "hand";
  skeleton.bones[2].parent = 1;
  skeleton.bones[2].extent = {2, 0, 0};
  return skeleton;
}

constexpr char kWave[] =
    "#!OML:ASF\r\n"
    ":FULLY-SPECIFIED\n"
    ":DEGREES\n"
    "1\n"
    "root 1 2 3 0 0\n"
    "arm 0\n"
    "2\n"
    "arm 90\n"
    "root 0 0 0 0 0\n"
    "3\n"
    "root 0 0 0 90 90\n"
    "arm 0\n"
    "hand\n";

void ExpectNear(Vec3d a, Vec3d b) { test::ExpectNear(a, b, 1e-5); }

TEST(AmcMotion, RotatesBonesAboutTheirOwnAxes) {
  const AsfSkeleton arm = Arm();
  const absl::StatusOr<AmcMotion> motion = ParseAmc(kWave, "a.amc", arm);
  ASSERT_TRUE(motion.ok()) << motion.status();
  ASSERT_EQ(motion->frame_count, 3);
  const AsfKinematics kinematics(arm, *motion);
  EXPECT_THAT(kinematics.ends(), ::testing::ElementsAre(2));
  std::vector<Vec3d> at = kinematics.Positions(0);
  ASSERT_EQ(at.size(), 4u);
  ExpectNear(at[0], {1, 2, 103});
  ExpectNear(at[1], {1, 2, 103});
  ExpectNear(at[2], {11, 2, 103});
  ExpectNear(at[3], {13, 2, 103});
  at = kinematics.Positions(1);  // 90 about y
  ExpectNear(at[2], {0, 0, 90});
  ExpectNear(at[3], {0, 0, 88});
  at = kinematics.Positions(2);  // the root about z, then about x
  ExpectNear(at[2], {0, 0, 110});
  ExpectNear(at[3], {0, 0, 112});
}

TEST(AmcMotion, ReadsRadiansIfMotionOrSkeletonStatesThem) {
  AsfSkeleton arm = Arm();
  const std::string quarter = "1\nroot 0 0 0 0 0\narm 1.5707963\n";
  for (const bool by_skeleton : {false, true}) {
    arm.radians = by_skeleton;
    const auto motion = ParseAmc(by_skeleton ? quarter : ":RADIANS\n" + quarter, "a.amc", arm);
    ASSERT_TRUE(motion.ok()) << motion.status();
    ExpectNear(AsfKinematics(arm, *motion).Positions(0)[2], {0, 0, 90});
  }
  arm.radians = true;
  const auto motion = ParseAmc(kWave, "a.amc", arm);  // :DEGREES
  ASSERT_TRUE(motion.ok()) << motion.status();
  ExpectNear(AsfKinematics(arm, *motion).Positions(1)[2], {0, 0, 90});
}

TEST(AmcMotion, NamesThePlaceOfAnError) {
  const auto error = [](const std::string& from, const std::string& to) {
    EXPECT_THAT(kWave, HasSubstr(from));
    const auto motion = ParseAmc(absl::StrReplaceAll(kWave, {{from, to}}), "a.amc", Arm());
    EXPECT_EQ(motion.status().code(), absl::StatusCode::kInvalidArgument) << from;
    return std::string(motion.status().message());
  };
  EXPECT_THAT(error("arm 90", "arm x"),
              HasSubstr("a.amc:8: \"arm\": expected a finite number, got \"x\""));
  EXPECT_THAT(error("arm 90", "arm nan"), HasSubstr("expected a finite number"));
  EXPECT_THAT(error("arm 90", "arm 90 1"), HasSubstr("\"arm\": expected 1 values, got 2"));
  EXPECT_THAT(error("arm 90", "leg 90"), HasSubstr("expected a bone of the skeleton, got \"leg\""));
  EXPECT_THAT(error("arm 90\n", ""),
              HasSubstr("frame 2, before this line: expected values for \"arm\""));
  EXPECT_THAT(error("arm 0\n2\n", "2\n"),
              HasSubstr("frame 1, before this line: expected values for \"arm\""));
  EXPECT_THAT(error("arm 90\n", "arm 90\narm 90\n"),
              HasSubstr("a.amc:9: \"arm\": expected once per frame, got twice"));
  EXPECT_THAT(error("1\nroot", "root"), HasSubstr("expected a frame number, got \"root\""));
  EXPECT_THAT(error("root 0 0 0 90 90\narm 0\nhand\n", ""),
              HasSubstr("frame 3, before this line: expected values for \"root\""));
  EXPECT_THAT(std::string(ParseAmc("", "a.amc", Arm()).status().message()),
              HasSubstr("a.amc:1: expected at least 1 frame, got none"));
}

}  // namespace
}  // namespace duet::formats::asf

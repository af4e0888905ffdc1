#include "model/formats/asf/asf_skeleton.h"

#include <string>

#include "absl/strings/str_replace.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/expect_near.h"
#include "tests/support/matchers.h"

namespace duet::formats::asf {
namespace {

using retargeting::Vec3d;

// The fore arm comes before the arm that it hangs from.
constexpr char kArm[] =
    "# by hand\r\n"
    ":version 1.10\n"
    ":units\n"
    "  length 0.45\n"
    "  angle deg\n"
    ":root\n"
    "  order TX TY TZ RZ RY RX\n"
    "  axis XYZ\n"
    "  position 1 2 3\n"
    "  orientation 0 0 90\n"
    ":bonedata\n"
    "  begin\n"
    "    id 2\n"
    "    name forearm\n"
    "    direction 0 0 2\n"
    "    length 5\n"
    "    axis 0 0 0 ZYX\n"
    "    dof rx\n"
    "    limits (-10 170)\n"
    "  end\n"
    "  begin\n"
    "    id 1\n"
    "    name arm\n"
    "    direction 1 0 0\n"
    "    length 10\n"
    "    axis 90 0 90 XYZ\n"
    "    dof rx rz\n"
    "    limits (-10 170)\n"
    "           (-90 90)\n"
    "  end\n"
    ":hierarchy\n"
    "  begin\n"
    "    root arm\n"
    "    arm forearm\n"
    "  end\n"
    ":skin arm.skin\n";

std::string ErrorWith(const std::string& from, const std::string& to) {
  EXPECT_THAT(kArm, HasSubstr(from));
  const auto skeleton = ParseAsf(absl::StrReplaceAll(kArm, {{from, to}}), "a.asf");
  EXPECT_EQ(skeleton.status().code(), absl::StatusCode::kInvalidArgument) << from;
  return std::string(skeleton.status().message());
}

void ExpectNear(Vec3d a, Vec3d b) { test::ExpectNear(a, b, 1e-9); }

TEST(AsfSkeleton, ReadsBonesParentsFirst) {
  const absl::StatusOr<AsfSkeleton> skeleton = ParseAsf(kArm, "a.asf");
  ASSERT_TRUE(skeleton.ok()) << skeleton.status();
  ASSERT_EQ(skeleton->bones.size(), 3u);
  EXPECT_EQ(skeleton->bones[0].name, "root");
  EXPECT_EQ(skeleton->bones[1].name, "arm");
  EXPECT_EQ(skeleton->bones[2].name, "forearm");
  EXPECT_EQ(skeleton->bones[1].parent, 0);
  EXPECT_EQ(skeleton->bones[2].parent, 1);
  ExpectNear(skeleton->position, {1, 2, 3});
  ExpectNear(skeleton->bones[1].extent, {10, 0, 0});
  ExpectNear(skeleton->bones[2].extent, {0, 0, 5});
  EXPECT_THAT(skeleton->bones[0].freedoms,
              ElementsAre(AsfFreedom::kTx, AsfFreedom::kTy, AsfFreedom::kTz, AsfFreedom::kRz,
                          AsfFreedom::kRy, AsfFreedom::kRx));
  EXPECT_THAT(skeleton->bones[1].freedoms, ElementsAre(AsfFreedom::kRx, AsfFreedom::kRz));
  EXPECT_FALSE(skeleton->radians);
  EXPECT_EQ(skeleton->Find("arm"), 1);
  EXPECT_EQ(skeleton->Find("leg"), -1);
}

// About x first, then about z: y goes to z and stays there.
TEST(AsfSkeleton, RotatesAxesInTheOrderOfTheirLetters) {
  const absl::StatusOr<AsfSkeleton> skeleton = ParseAsf(kArm, "a.asf");
  ASSERT_TRUE(skeleton.ok()) << skeleton.status();
  ExpectNear(Rotate(skeleton->bones[1].axes, {0, 1, 0}), {0, 0, 1});
  ExpectNear(Rotate(skeleton->bones[1].axes, {1, 0, 0}), {0, 1, 0});
  ExpectNear(Rotate(skeleton->bones[0].axes, {1, 0, 0}), {0, 1, 0});
  const auto other = ParseAsf(absl::StrReplaceAll(kArm, {{"90 XYZ", "90 ZYX"}}), "a.asf");
  ASSERT_TRUE(other.ok()) << other.status();
  ExpectNear(Rotate(other->bones[1].axes, {0, 1, 0}), {-1, 0, 0});
}

TEST(AsfSkeleton, ReadsRadians) {
  const auto skeleton = ParseAsf(
      absl::StrReplaceAll(kArm, {{"angle deg", "angle rad"}, {"0 0 90\n", "0 0 1.5707963\n"}}),
      "a.asf");
  ASSERT_TRUE(skeleton.ok()) << skeleton.status();
  EXPECT_TRUE(skeleton->radians);
  EXPECT_NEAR(Rotate(skeleton->bones[0].axes, {1, 0, 0}).y, 1, 1e-6);
}

TEST(AsfSkeleton, NamesThePlaceOfAnError) {
  EXPECT_THAT(ErrorWith("position 1 2 3", "position 1 2 x"),
              HasSubstr("a.asf:9: position: expected three numbers, got \"position 1 2 x\""));
  EXPECT_THAT(ErrorWith("direction 0 0 2", "direction 0 0"), HasSubstr("a.asf:15: direction"));
  EXPECT_THAT(ErrorWith("length 5", "length far"),
              HasSubstr("length: expected a number, got \"length far\""));
  EXPECT_THAT(ErrorWith("0 0 0 ZYX", "0 0 0 ZYQ"), HasSubstr("an order of axes such as XYZ"));
  EXPECT_THAT(ErrorWith("0 0 0 ZYX", "0 0 0 ZYXZ"), HasSubstr("an order of axes"));
  EXPECT_THAT(ErrorWith("dof rx\n", "dof rx tx\n"), HasSubstr("expected rx ry rz"));
  EXPECT_THAT(ErrorWith("dof rx\n", "dof rx rx\n"), HasSubstr("each at most once"));
  EXPECT_THAT(ErrorWith("order TX", "order L"), HasSubstr("order: expected TX"));
  EXPECT_THAT(ErrorWith("angle deg", "angle grad"), HasSubstr("angle deg or angle rad"));
  EXPECT_THAT(ErrorWith("name forearm", "id 3"),
              HasSubstr("a.asf:20: name: expected a word, got none"));
  EXPECT_THAT(ErrorWith("name forearm", "name arm"),
              HasSubstr("expected a new bone, got \"arm\" again"));
  EXPECT_THAT(ErrorWith("  begin\n    id 2\n", "    id 2\n"), HasSubstr("expected begin"));
  EXPECT_THAT(ErrorWith("  end\n:hierarchy", ":hierarchy"), HasSubstr("expected end"));
  EXPECT_THAT(ErrorWith("  end\n:skin arm.skin\n", ""), HasSubstr("got the end of the file"));
}

TEST(AsfSkeleton, RejectsBonesThatAreNotATreeBelowTheRoot) {
  EXPECT_THAT(ErrorWith("    arm forearm\n", ""),
              HasSubstr("a.asf: hierarchy: expected all 2 bones below the root, got 1"));
  EXPECT_THAT(ErrorWith("root arm\n", "forearm arm\n"), HasSubstr("bones below the root, got 0"));
  EXPECT_THAT(ErrorWith("arm forearm\n", "arm leg\n"), HasSubstr("expected a bone, got \"leg\""));
  EXPECT_THAT(ErrorWith("arm forearm\n", "arm forearm forearm\n"),
              HasSubstr("expected one parent for \"forearm\", got two"));
  EXPECT_THAT(ErrorWith("arm forearm\n", "arm forearm root\n"),
              HasSubstr("expected one parent for"));
  EXPECT_THAT(ErrorWith("arm forearm\n", "arm\n"), HasSubstr("expected a bone and its children"));
  EXPECT_THAT(std::string(ParseAsf("", "a.asf").status().message()),
              HasSubstr("a.asf:1: :bonedata: expected at least 1 bone, got none"));
}

}  // namespace
}  // namespace duet::formats::asf

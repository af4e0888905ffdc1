#include "model/motion/body_part.h"

#include <algorithm>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"

namespace duet::motion {
namespace {

TEST(SbuParts, AreFiveOfThreeJoints) {
  const std::vector<BodyPart> parts = SbuParts();
  EXPECT_THAT(Validate(parts, SbuSkeleton()), IsOk());
  ASSERT_EQ(parts.size(), 5u);
  std::vector<int> joints;
  for (const BodyPart& part : parts) {
    EXPECT_EQ(part.joints.size(), 3u) << part.name;
    joints.insert(joints.end(), part.joints.begin(), part.joints.end());
  }
  std::sort(joints.begin(), joints.end());
  EXPECT_THAT(joints, ::testing::ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14));
}

TEST(BodyParts, AreRejectedByName) {
  const auto refused = [](const std::vector<BodyPart>& parts, const char* why) {
    EXPECT_THAT(Validate(parts, SbuSkeleton()),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr(why)));
  };
  refused({}, "parts: expected at least one, got none");
  refused({{"arm", {3}}, {"trunk", {}}}, "parts: expected at least one joint of \"trunk\"");
  refused({{"trunk", {0, 15}}}, "parts.trunk: expected a joint index from 0 to 14, got 15");
  refused({{"trunk", {-1}}}, "parts.trunk: expected a joint index from 0 to 14, got -1");
}

}  // namespace
}  // namespace duet::motion

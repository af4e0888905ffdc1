#include "model/retargeting/joint_table.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"

namespace duet::retargeting {
namespace {

TEST(JointTable, ReadsOneJointPerLine) {
  const absl::StatusOr<JointOverrides> table = ParseJointTable(
      "\xEF\xBB\xBF# ours\r\n\r\nleft_hand=LeftWrist\r\n  torso = Chest 3 \r\nhead=a=b", "a.txt");
  ASSERT_TRUE(table.ok()) << table.status();
  EXPECT_THAT(*table, ElementsAre(Pair("head", "a=b"), Pair("left_hand", "LeftWrist"),
                                  Pair("torso", "Chest 3")));
}

TEST(JointTable, MayBeEmpty) {
  const absl::StatusOr<JointOverrides> table = ParseJointTable("", "a.txt");
  ASSERT_TRUE(table.ok()) << table.status();
  EXPECT_THAT(*table, IsEmpty());
}

TEST(JointTable, NamesTheLineOfAnError) {
  for (const char* bad : {"head", "=Head", "head=", "head = "}) {
    const auto status = ParseJointTable(std::string("# one\n") + bad + "\n", "a.txt").status();
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument) << bad;
    EXPECT_THAT(std::string(status.message()),
                HasSubstr("a.txt:2: expected MODEL_JOINT=FILE_JOINT"))
        << bad;
  }
  EXPECT_THAT(std::string(ParseJointTable("head=a\nhead = b\n", "a.txt").status().message()),
              HasSubstr("a.txt:2: expected each joint once, got \"head\" twice"));
}

}  // namespace
}  // namespace duet::retargeting

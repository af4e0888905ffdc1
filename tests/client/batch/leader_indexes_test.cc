#include "client/batch/leader_indexes.h"

#include <filesystem>
#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::client::batch {
namespace {

using dataset::LeaderSide;

class LeaderIndexesTest : public ::testing::Test {
 protected:
  LeaderIndexesTest() {
    std::filesystem::create_directories(folder_ / "sbu/s01s02/03/001");
    test::WriteTestFile(folder_ / "sbu/index.tsv",
                        "path\tset\tleader_side\tgroup\n"
                        "s01s02/03/001/skeleton_pos.txt\ts01s02\tright\tfirst\n"
                        "a.txt\t\tleft\t\n");
  }
  test::TemporaryFolder folder_;
  LeaderIndexes indexes_;
};

TEST_F(LeaderIndexesTest, FindTheNearestIndexAbove) {
  const auto deep = indexes_.Find(folder_ / "sbu/s01s02/03/001/skeleton_pos.txt");
  ASSERT_THAT(deep, IsOk());
  ASSERT_NE(*deep, nullptr);
  EXPECT_EQ((*deep)->leader_side, LeaderSide::kRight);
  EXPECT_EQ((*deep)->group, "first");
  EXPECT_EQ((*indexes_.Find(folder_ / "sbu/./s01s02/../a.txt"))->leader_side, LeaderSide::kLeft);
  EXPECT_EQ(*indexes_.Find(folder_ / "sbu/b.txt"), nullptr) << "not listed";
  EXPECT_EQ(*indexes_.Find(folder_ / "a.txt"), nullptr) << "no index above";
  EXPECT_EQ(*indexes_.Find(folder_ / "sbu/1/2/3/4/a.txt"), nullptr) << "too far up";
}

TEST_F(LeaderIndexesTest, OtherTablesOfThatNameAreNoIndexes) {
  test::WriteTestFile(folder_ / "sbu/s01s02/index.tsv", "item\tid\tname\n0\tx\ty\n");
  EXPECT_NE(*indexes_.Find(folder_ / "sbu/s01s02/03/001/skeleton_pos.txt"), nullptr);
}

TEST_F(LeaderIndexesTest, InvalidIndexIsReported) {
  test::WriteTestFile(folder_ / "sbu/index.tsv", "path\tleader_side\na.txt\tmiddle\n");
  EXPECT_THAT(indexes_.Find(folder_ / "sbu/a.txt"),
              StatusIs(absl::StatusCode::kFailedPrecondition,
                       HasSubstr("sbu/index.tsv: line 2: expected leader_side left, right or "
                                 "unknown, got \"middle\"")));
}

}  // namespace
}  // namespace duet::client::batch

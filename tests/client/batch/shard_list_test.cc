#include "client/batch/shard_list.h"

#include <filesystem>
#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::client::batch {
namespace {

using test::ReadTestFile;
using test::WriteTestFile;

class ShardListTest : public ::testing::Test {
 protected:
  ShardList Open() {
    absl::StatusOr<ShardList> list = ShardList::Open(file_);
    EXPECT_THAT(list, IsOk());
    return *std::move(list);
  }

  test::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "shards";
};

TEST_F(ShardListTest, FillsShardsInTheOrderOfTheItems) {
  ShardList list = Open();
  EXPECT_TRUE(list.empty());
  // Item 3 was rejected, item 5 is larger than a shard.
  for (const int64_t item : {0, 1, 2, 4}) list.Add(item, 40, 100);
  list.Add(5, 400, 100);
  list.Add(6, 40, 100);
  ASSERT_THAT(list.Commit(), IsOk());
  const ShardList again = Open();
  ASSERT_EQ(again.shards().size(), 4u);
  EXPECT_THAT(again.shards()[0].items, ElementsAre(Pair(0, 1)));
  EXPECT_THAT(again.shards()[1].items, ElementsAre(Pair(2, 2), Pair(4, 4)));
  EXPECT_THAT(again.shards()[2].items, ElementsAre(Pair(5, 5)));
  EXPECT_EQ(again.ShardOf(4), 1u);
  EXPECT_EQ(again.ShardOf(3), ShardList::kNone);
  EXPECT_EQ(again.ShardOf(7), ShardList::kNone);
}

TEST_F(ShardListTest, ShardHasTheItemsOfOneSplit) {
  ShardList list = Open();
  for (const int64_t item : {0, 1, 2, 3}) {
    list.Add(item, 40, 100, item % 2 == 0 ? "train" : "test");
  }
  list.Add(4, 40, 100, "train");
  ASSERT_THAT(list.Commit(), IsOk());
  const ShardList again = Open();
  ASSERT_EQ(again.shards().size(), 3u);
  EXPECT_THAT(again.shards()[0].items, ElementsAre(Pair(0, 0), Pair(2, 2)));
  EXPECT_EQ(again.NameOf(0, Packing::kTar), "set-train-000000.tar");
  EXPECT_THAT(again.shards()[1].items, ElementsAre(Pair(1, 1), Pair(3, 3)));
  EXPECT_EQ(again.NameOf(1, Packing::kNpz), "set-test-000001.npz");
  EXPECT_EQ(again.NameOf(again.ShardOf(4), Packing::kTar), "set-train-000002.tar");
}

TEST_F(ShardListTest, LaterItemsGoToNewShards) {
  ShardList list = Open();
  list.Add(0, 10, 100);
  list.Add(2, 10, 100);
  ASSERT_THAT(list.Commit(), IsOk());
  list.Set(0, {list.shards()[0].items, 20, "digest", ""});
  ASSERT_THAT(list.Commit(), IsOk());
  ShardList later = Open();
  later.Add(1, 10, 100);
  ASSERT_THAT(later.Commit(), IsOk());
  const ShardList again = Open();
  ASSERT_EQ(again.shards().size(), 2u);
  EXPECT_EQ(again.shards()[0].sha256, "digest");
  EXPECT_EQ(again.shards()[0].bytes, 20u);
  EXPECT_EQ(again.ShardOf(1), 1u);
  EXPECT_EQ(again.ShardOf(2), 0u);
}

TEST_F(ShardListTest, LostShardIsFilledFirst) {
  ShardList list = Open();
  for (const int64_t item : {0, 1, 2}) list.Add(item, 100, 100);
  ASSERT_THAT(list.Commit(), IsOk());
  std::string text = ReadTestFile(file_);
  text[text.find('\n') + 20] ^= 1;
  WriteTestFile(file_, text);
  ShardList again = Open();
  EXPECT_EQ(again.ShardOf(1), ShardList::kNone);
  EXPECT_THAT(again.shards()[1].items, IsEmpty());
  again.Add(1, 100, 100);
  again.Add(3, 100, 100);
  ASSERT_THAT(again.Commit(), IsOk());
  EXPECT_EQ(Open().ShardOf(1), 1u);
  EXPECT_EQ(Open().ShardOf(3), 3u);
}

TEST_F(ShardListTest, TruncatedListLosesOnlyWholeShards) {
  ShardList list = Open();
  for (const int64_t item : {0, 1, 2, 3}) list.Add(item, 50, 100);
  ASSERT_THAT(list.Commit(), IsOk());
  const std::string whole = ReadTestFile(file_);
  for (size_t size = 0; size < whole.size(); ++size) {
    WriteTestFile(file_, whole.substr(0, size));
    ShardList torn = Open();
    for (int64_t item = 0; item < 4; ++item) {
      if (torn.ShardOf(item) == ShardList::kNone) torn.Add(item, 50, 100);
    }
    ASSERT_THAT(torn.Commit(), IsOk());
    EXPECT_EQ(Open().ShardOf(1), 0u) << size;
    EXPECT_EQ(Open().ShardOf(2), 1u) << size;
  }
}

}  // namespace
}  // namespace duet::client::batch

#include "client/batch/item_files.h"

#include <sys/stat.h>

#include "client/batch/durable_file.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/base/sha256.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::client::batch {
namespace {

using nlohmann::ordered_json;
using test::ReadTestFile;

class ItemFilesTest : public ::testing::Test {
 protected:
  void SetUp() override {
    JobIdentity begun;
    ASSERT_THAT(folder_.Open({}, &begun), IsOk());
  }
  static ordered_json Record(const std::vector<ItemFile>& files) {
    ordered_json record;
    for (const ItemFile& file : files) {
      record["files"].push_back({{"path", file.path},
                                 {"bytes", file.content.size()},
                                 {"sha256", base::Sha256Hex(file.content)}});
    }
    return record;
  }
  ItemReader Reader(Packing packing) { return {folder_.items(packing), folder_.spool()}; }
  // Of the spool, on the disk.
  int64_t Blocks() {
    struct stat found {};
    EXPECT_EQ(stat(folder_.spool().c_str(), &found), 0);
    return found.st_blocks;
  }

  test::TemporaryFolder temporary_;
  JobFolder folder_{temporary_.path()};
  const std::vector<ItemFile> two_ = {{"walks/a.leader.bvh", "first"},
                                      {"walks/a.bvh", "and second"}};
};

TEST_F(ItemFilesTest, CommitRenamesTheFiles) {
  const auto writer = MakeItemWriter(folder_, Packing::kNone);
  EXPECT_EQ(*writer->Add(two_), SpoolPlace());
  EXPECT_FALSE(std::filesystem::exists(folder_.out() / "walks"));
  ASSERT_THAT(writer->Commit(), IsOk());
  EXPECT_EQ(ReadTestFile(folder_.out() / "walks/a.leader.bvh"), "first");
  EXPECT_TRUE(std::filesystem::is_empty(folder_.temporary()));
  EXPECT_EQ(*Reader(Packing::kNone).Read(Record(two_), {}, 1), "and second");
}

TEST_F(ItemFilesTest, UncommittedFilesAreRemoved) {
  EXPECT_THAT(MakeItemWriter(folder_, Packing::kNone)->Add(two_), IsOk());
  EXPECT_TRUE(std::filesystem::is_empty(folder_.temporary()));
}

TEST_F(ItemFilesTest, ItemsOfPackedSetsAreInTheSpool) {
  SpoolPlace first, second;
  {
    const auto writer = MakeItemWriter(folder_, Packing::kTar);
    first = *writer->Add(two_);
    ASSERT_THAT(writer->Commit(), IsOk());
    // Never committed, and skipped by the next run.
    ASSERT_THAT(writer->Add({{"b", std::string(2 << 20, 'x')}}), IsOk());
  }
  const auto writer = MakeItemWriter(folder_, Packing::kTar);
  second = *writer->Add({{"c", "third"}});
  ASSERT_THAT(writer->Commit(), IsOk());
  const ItemReader reader = Reader(Packing::kTar);
  EXPECT_EQ(*reader.Read(Record(two_), first, 0), "first");
  EXPECT_EQ(*reader.Read(Record(two_), first, 1), "and second");
  EXPECT_EQ(*reader.Read(Record({{"c", "third"}}), second, 0), "third");
  EXPECT_THAT(reader.Read(Record({{"c", "thirD"}}), second, 0),
              StatusIs(absl::StatusCode::kDataLoss, HasSubstr("c: was changed")));
  EXPECT_THAT(reader.Read(Record({{"c", "third and more"}}), second, 0),
              StatusIs(absl::StatusCode::kDataLoss, HasSubstr("is truncated")));
}

TEST_F(ItemFilesTest, ForgettingAnItemFreesItsDiskSpace) {
  const std::vector<ItemFile> large = {{"a", std::string(1 << 20, 'a')}};
  const auto writer = MakeItemWriter(folder_, Packing::kNpz);
  const SpoolPlace first = *writer->Add(large), second = *writer->Add(large);
  ASSERT_THAT(writer->Commit(), IsOk());
  const int64_t before = Blocks();
  ItemReader reader = Reader(Packing::kNpz);
  reader.Forget(Record(large), first);
  reader.Release();
  EXPECT_LT(Blocks(), before * 3 / 4);
  EXPECT_EQ(*reader.Read(Record(large), second, 0), large[0].content);
}

}  // namespace
}  // namespace duet::client::batch

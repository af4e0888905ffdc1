#include "client/batch/set_file.h"

#include <filesystem>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::client::batch {
namespace {

class SetFilesTest : public ::testing::Test {
 protected:
  // Writes the same pieces to any kind of files.
  static void Fill(SetFiles* files) {
    auto table = files->Begin("items/train.csv");
    ASSERT_THAT(table, IsOk());
    ASSERT_THAT((*table)->Append("id,"), IsOk());
    ASSERT_THAT((*table)->Append("name\n"), IsOk());
    ASSERT_THAT((*table)->Finish(), IsOk());
    ASSERT_THAT(files->Put("empty", ""), IsOk());
  }

  void Write() {
    WrittenSetFiles files(temporary_.path(), out_);
    Fill(&files);
  }
  ComparedSetFiles Compare() {
    ComparedSetFiles files(out_);
    Fill(&files);
    return files;
  }

  test::TemporaryFolder folder_, temporary_;
  const std::filesystem::path out_ = folder_ / "set";
};

TEST_F(SetFilesTest, WrittenFilesAreTheSame) {
  Write();
  EXPECT_EQ(test::ReadTestFile(out_ / "items/train.csv"), "id,name\n");
  EXPECT_TRUE(std::filesystem::is_empty(temporary_.path()));
  const ComparedSetFiles compared = Compare();
  EXPECT_THAT(compared.missing(), IsEmpty());
  EXPECT_THAT(compared.different(), IsEmpty());
}

TEST_F(SetFilesTest, ChangedShorterAndLongerFilesDiffer) {
  Write();
  for (const char* content : {"id,nane\n", "id,name", "", "id,name\nmore\n"}) {
    test::WriteTestFile(out_ / "items/train.csv", content);
    EXPECT_THAT(Compare().different(), ElementsAre("items/train.csv")) << content;
  }
}

TEST_F(SetFilesTest, MissingFilesAreReportedAndNotMade) {
  Write();
  std::filesystem::remove(out_ / "empty");
  EXPECT_THAT(Compare().missing(), ElementsAre("empty"));
  EXPECT_FALSE(std::filesystem::exists(out_ / "empty"));
}

TEST_F(SetFilesTest, UnfinishedFileDoesNotReplaceTheLastOne) {
  Write();
  WrittenSetFiles files(temporary_.path(), out_);
  auto table = files.Begin("items/train.csv");
  ASSERT_THAT(table, IsOk());
  ASSERT_THAT((*table)->Append("half"), IsOk());
  table->reset();
  EXPECT_EQ(test::ReadTestFile(out_ / "items/train.csv"), "id,name\n");
}

}  // namespace
}  // namespace duet::client::batch

#include "client/batch/journal.h"

#include <sys/resource.h>

#include <csignal>
#include <string>
#include <vector>

#include "client/batch/durable_file.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::client::batch {
namespace {

using test::ReadTestFile;
using test::WriteTestFile;

// While it lives, files take this many bytes and no more, as if the disk were full.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) : handler_(signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    signal(SIGXFSZ, handler_);
  }

 private:
  void (*handler_)(int);
  rlimit before_{};
};

class JournalTest : public ::testing::Test {
 protected:
  void Append(const std::vector<std::pair<int64_t, std::string>>& records) {
    const auto before = JournalReader::Open(path_);
    ASSERT_THAT(before, IsOk());
    JournalWriter writer;
    ASSERT_THAT(writer.Open(path_, before->size()), IsOk());
    for (const auto& [item, record] : records) writer.Add(item, record);
    EXPECT_THAT(writer.Commit(), IsOk());
  }
  std::vector<std::string> Records() {
    std::vector<std::string> records;
    const auto reader = JournalReader::Open(path_);
    EXPECT_THAT(reader, IsOk());
    EXPECT_THAT(reader->ForEach([&records](int64_t item, const std::string& record) {
      records.push_back(std::to_string(item) + record);
      return absl::OkStatus();
    }),
                IsOk());
    return records;
  }
  test::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "journal";
};

TEST_F(JournalTest, RecordsAreInTheOrderOfItems) {
  Append({{5, "{five}"}, {0, "{zero}"}});
  Append({{2, std::string(10000, 'x')}});
  EXPECT_THAT(Records(), ElementsAre("0{zero}", "2" + std::string(10000, 'x'), "5{five}"));
  const auto reader = JournalReader::Open(path_);
  EXPECT_EQ(reader->count(), 3);
  EXPECT_EQ(reader->end(), 6);
  EXPECT_TRUE(reader->Has(5));
  EXPECT_FALSE(reader->Has(1));
  EXPECT_FALSE(reader->Has(6));
  Append({{5, "failed"}, {5, "done"}});
  EXPECT_EQ(Records()[2], "5done") << "the last record of an item counts";
}

TEST_F(JournalTest, TruncatedLastLineIsIgnoredAndOverwritten) {
  Append({{0, "zero"}, {1, "one"}});
  const std::string whole = ReadTestFile(path_);
  const size_t first = whole.find('\n') + 1;
  for (size_t size = first; size < whole.size(); ++size) {
    WriteTestFile(path_, whole.substr(0, size));
    EXPECT_THAT(Records(), ElementsAre("0zero")) << size;
  }
  std::string damaged = whole;
  damaged[whole.size() - 2] ^= 1;
  WriteTestFile(path_, damaged);
  EXPECT_THAT(Records(), ElementsAre("0zero"));
  Append({{2, "two"}});
  EXPECT_THAT(Records(), ElementsAre("0zero", "2two"));
}

TEST_F(JournalTest, DamagedLineLosesOnlyItsItem) {
  Append({{0, "zero"}, {1, "one"}, {2, "two"}});
  const std::string whole = ReadTestFile(path_);
  const size_t first = whole.find('\n') + 1;
  // Any byte of the line in the middle; its end takes the next line with it.
  for (size_t at = first; at < whole.find('\n', first); ++at) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 4);
    WriteTestFile(path_, damaged);
    EXPECT_THAT(Records(), ElementsAre("0zero", "2two")) << at;
    Append({{1, "one"}});
    EXPECT_THAT(Records(), ElementsAre("0zero", "1one", "2two")) << at;
  }
}

TEST_F(JournalTest, TooLargeItemNumberIsAnErrorWithoutAllocation) {
  Append({{0, "zero"}, {kMaxItems - 1, "last"}});
  EXPECT_THAT(JournalReader::Open(path_), IsOk());
  Append({{kMaxItems, "beyond"}});
  EXPECT_THAT(JournalReader::Open(path_),
              StatusIs(absl::StatusCode::kDataLoss,
                       HasSubstr("item: expected a number below 67108864, got 67108864")));
}

TEST_F(JournalTest, FullDiskIsAnError) {
  Append({{0, "zero"}});
  {
    JournalWriter writer;
    ASSERT_THAT(writer.Open(path_, JournalReader::Open(path_)->size()), IsOk());
    const FullDisk full(60);
    writer.Add(1, std::string(100, 'x'));
    EXPECT_THAT(writer.Commit(), StatusIs(absl::StatusCode::kAborted, HasSubstr("cannot write")));
    writer.Add(2, "two");
    EXPECT_THAT(writer.Commit(), StatusIs(absl::StatusCode::kAborted, HasSubstr("cannot write")));
  }
  EXPECT_THAT(Records(), ElementsAre("0zero"));
  Append({{1, "one"}});
  EXPECT_THAT(Records(), ElementsAre("0zero", "1one"));
}

TEST(FileGroup, FilesAppearTogetherWhenTheyAreCommitted) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directory(folder / "tmp");
  {
    FileGroup files(folder / "tmp", folder.path());
    EXPECT_THAT(files.Add("a/b.npy", "b"), IsOk());
    EXPECT_THAT(files.Add("c.npy", "c"), IsOk());
    EXPECT_FALSE(std::filesystem::exists(folder / "c.npy"));
    EXPECT_THAT(files.Commit(), IsOk());
    EXPECT_EQ(ReadTestFile(folder / "a/b.npy"), "b");
    EXPECT_EQ(ReadTestFile(folder / "c.npy"), "c");
    EXPECT_THAT(files.Add("d.npy", "d"), IsOk());
  }
  {
    FileGroup files(folder / "tmp", folder.path());
    EXPECT_THAT(files.Add("c.npy/d.npy", "d"), IsOk());
    EXPECT_THAT(files.Commit(),
                StatusIs(absl::StatusCode::kFailedPrecondition, HasSubstr("c.npy")));
  }
  {
    FileGroup files(folder / "tmp", folder.path());
    const FullDisk full(3);
    EXPECT_THAT(files.Add("d.npy", "content"),
                StatusIs(absl::StatusCode::kAborted, HasSubstr("cannot write")));
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "d.npy"));
  EXPECT_TRUE(std::filesystem::is_empty(folder / "tmp"));
}

}  // namespace
}  // namespace duet::client::batch

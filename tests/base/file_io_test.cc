#include "model/base/file_io.h"

#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>

#include "gtest/gtest.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::base {
namespace {

using test::ReadTestFile;
using test::TemporaryFolder;
using test::WriteTestFile;

namespace fs = std::filesystem;
using ::testing::_;

constexpr std::size_t kMax = 100;

auto Refused(const std::string& why) {
  return StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr(why));
}

absl::StatusOr<std::string> ReadIn(const fs::path& folder, const std::string& name) {
  const absl::StatusOr<Folder> files = Folder::Open(folder);
  if (!files.ok()) return files.status();
  return files->Read(name, kMax);
}

TEST(Folder, ReadsFilesUpToTheLimit) {
  const TemporaryFolder folder;
  WriteTestFile(folder / "empty", "");
  WriteTestFile(folder / "full", std::string(kMax, 'x'));
  WriteTestFile(folder / "over", std::string(kMax + 1, 'x'));
  EXPECT_EQ(*ReadIn(folder.path(), "empty"), "");
  EXPECT_EQ(*ReadIn(folder.path(), "full"), std::string(kMax, 'x'));
  EXPECT_THAT(ReadIn(folder.path(), "over"), Refused("expected at most 100 bytes, got 101"));
}

TEST(Folder, StaysInTheFolderThatWasOpened) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "a");
  WriteTestFile(folder / "a/file", "first");
  const absl::StatusOr<Folder> open = Folder::Open(folder / "a");
  ASSERT_THAT(open, IsOk());
  fs::rename(folder / "a", folder / "b");
  fs::create_directory(folder / "a");
  WriteTestFile(folder / "a/file", "second");
  EXPECT_EQ(*open->Read("file", kMax), "first");
}

TEST(Folder, RejectsOtherKindsOfFiles) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "folder");
  // A reader that opened it as a file would wait for ever.
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_THAT(ReadIn(folder.path(), "folder"), Refused("expected a regular file"));
  EXPECT_THAT(ReadIn(folder.path(), "pipe"), Refused("expected a regular file"));
}

TEST(WriteFolder, CreatesParentsAndFiles) {
  const TemporaryFolder folder;
  ASSERT_THAT(WriteFolder(folder / "x/y/z", {{"a", "1"}, {"b", ""}}), IsOk());
  EXPECT_EQ(ReadTestFile(folder / "x/y/z/a"), "1");
  EXPECT_EQ(ReadTestFile(folder / "x/y/z/b"), "");
}

TEST(WriteFolder, ReplacesNothing) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "empty");
  WriteTestFile(folder / "file", "kept");
  fs::create_directory_symlink(folder / "nowhere", folder / "link");
  for (const char* name : {"empty", "file", "link"}) {
    EXPECT_THAT(WriteFolder(folder / name, {{"a", "1"}}),
                StatusIs(absl::StatusCode::kAlreadyExists, HasSubstr(name)));
  }
  EXPECT_TRUE(fs::is_empty(folder / "empty"));
  EXPECT_EQ(ReadTestFile(folder / "file"), "kept");
}

TEST(WriteFolder, LeavesNothingWhenAFileCannotBeWritten) {
  const TemporaryFolder folder;
  EXPECT_THAT(WriteFolder(folder / "x", {{"a", "1"}, {"no/such/folder", "2"}}),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr("no/such/folder")));
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

// Within a lifetime, no file may become larger, as on a full disk.
class LargestFile {
 public:
  explicit LargestFile(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit = {bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~LargestFile() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  LargestFile(const LargestFile&) = delete;
  LargestFile& operator=(const LargestFile&) = delete;

 private:
  void (*const handler_)(int) = std::signal(SIGXFSZ, SIG_IGN);
  rlimit before_ = {};
};

TEST(WriteFolder, LeavesNothingWhenTheDiskIsFullWithinAFile) {
  const TemporaryFolder folder;
  absl::Status status;
  {
    const LargestFile limit(1000);
    status = WriteFolder(folder / "x", {{"a", std::string(1001, 'a')}});
  }
  EXPECT_FALSE(status.ok());
  EXPECT_THAT(std::string(status.message()), HasSubstr("/a"));
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

}  // namespace
}  // namespace duet::base

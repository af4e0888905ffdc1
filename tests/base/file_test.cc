#include "model/base/file.h"

#include <sys/stat.h>

#include <filesystem>
#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::base {
namespace {

namespace fs = std::filesystem;

class FileTest : public ::testing::Test {
 protected:
  fs::path Path(const char* name) const { return folder_ / name; }
  test::TemporaryFolder folder_;
};

TEST_F(FileTest, ReadsBackWhatWasWritten) {
  const std::string content("a\0\r\n\xff", 5);
  ASSERT_THAT(WriteFile(Path("a"), "longer before"), IsOk());
  ASSERT_THAT(WriteFile(Path("a"), content), IsOk());
  const absl::StatusOr<std::string> read = ReadFile(Path("a"), 5, "a test");
  ASSERT_THAT(read, IsOk());
  EXPECT_EQ(*read, content);
}

TEST_F(FileTest, LargeFileIsRejectedWithItsExpectedKind) {
  test::WriteTestFile(Path("a.pem"), std::string((1 << 20) + 1, 'x'));
  EXPECT_THAT(ReadFile(Path("a.pem"), 1 << 20, "a PEM file"),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       AllOf(HasSubstr(Path("a.pem").string()),
                             HasSubstr("expected a PEM file of at most 1 MiB, got more"))));
  EXPECT_THAT(ReadFile(Path("a.pem"), 1000, "a PEM file"),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("at most 1000 bytes")));
  EXPECT_THAT(ReadFile(Path("a.pem"), (1 << 20) + 1, "a PEM file"), IsOk());
}

TEST_F(FileTest, ReportsThePathThatCannotBeRead) {
  EXPECT_THAT(ReadFile(Path("none"), 9, "a test"),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr(Path("none").string())));
  fs::create_directory(Path("folder"));
  EXPECT_THAT(ReadFile(Path("folder"), 9, "a test"),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("got a folder")));
}

// Opening a named pipe waits for its writer: a leader that is one once hung the program.
TEST_F(FileTest, RejectsANamedPipeWithoutWaitingForAWriter) {
  ASSERT_EQ(mkfifo(Path("pipe").c_str(), 0600), 0);
  EXPECT_THAT(
      ReadFile(Path("pipe"), 9, "a test"),
      StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("expected a file, got a named pipe")));
  EXPECT_THAT(ReadFile("/dev/zero", 9, "a test"),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("got a device")));
}

TEST_F(FileTest, ReportsThePathThatCannotBeWritten) {
  fs::create_directory(Path("folder"));
  EXPECT_THAT(WriteFile(Path("folder"), "x"), StatusIs(absl::StatusCode::kInvalidArgument,
                                                       HasSubstr("expected a file, got a folder")));
  EXPECT_THAT(WriteFile(Path("no") / "file", "x"),
              StatusIs(absl::StatusCode::kPermissionDenied, HasSubstr("cannot be written")));
  fs::create_directory_symlink(Path("loop"), Path("loop"));
  EXPECT_THAT(WriteFile(Path("loop") / "file", "x"),
              StatusIs(absl::StatusCode::kFailedPrecondition,
                       HasSubstr("cannot be written: Too many levels of symbolic links")));
  EXPECT_THAT(WriteFile("/dev/full", "x"),
              StatusIs(absl::StatusCode::kPermissionDenied,
                       HasSubstr("/dev/full: cannot be written: No space left on device")));
}

absl::Status NotFound(const fs::path& path, absl::string_view rest) {
  return absl::NotFoundError(path.string() + std::string(rest));
}

TEST(MissingFile, SaysWhereASymbolicLinkLeads) {
  test::TemporaryFolder folder;
  fs::create_symlink("gone.bvh", folder / "link.bvh");
  EXPECT_EQ(MissingFile(folder / "link.bvh"),
            NotFound(folder / "link.bvh", ": no such file; it is a symbolic link to gone.bvh"));
}

TEST(MissingFile, RecognisesLinksInACircle) {
  test::TemporaryFolder folder;
  fs::create_symlink("b.bvh", folder / "a.bvh");
  fs::create_symlink("a.bvh", folder / "b.bvh");
  EXPECT_EQ(MissingFile(folder / "a.bvh"),
            NotFound(folder / "a.bvh",
                     ": no such file; it is a symbolic link that leads back to itself"));
}

}  // namespace
}  // namespace duet::base

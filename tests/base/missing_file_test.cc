#include "model/base/missing_file.h"

#include <filesystem>
#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::base {
namespace {

namespace fs = std::filesystem;

using duet::test::TemporaryFolder;

absl::Status NotFound(const fs::path& path, absl::string_view rest) {
  return absl::NotFoundError(path.string() + std::string(rest));
}

TEST(MissingFile, NamesThePathAndWhatWasExpected) {
  EXPECT_EQ(MissingFile("a.bvh"), NotFound("a.bvh", ": no such file"));
  EXPECT_EQ(MissingFile("a.bvh", "file or folder"), NotFound("a.bvh", ": no such file or folder"));
}

TEST(MissingFile, SaysWhereASymbolicLinkLeads) {
  TemporaryFolder folder;
  fs::create_symlink("gone.bvh", folder / "link.bvh");
  EXPECT_EQ(MissingFile(folder / "link.bvh"),
            NotFound(folder / "link.bvh", ": no such file; it is a symbolic link to gone.bvh"));
}

TEST(MissingFile, RecognisesLinksInACircle) {
  TemporaryFolder folder;
  fs::create_symlink("b.bvh", folder / "a.bvh");
  fs::create_symlink("a.bvh", folder / "b.bvh");
  EXPECT_EQ(MissingFile(folder / "a.bvh"),
            NotFound(folder / "a.bvh",
                     ": no such file; it is a symbolic link that leads back to itself"));
}

}  // namespace
}  // namespace duet::base

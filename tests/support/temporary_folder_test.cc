#include "tests/support/temporary_folder.h"

#include "gtest/gtest.h"

namespace duet::test {
namespace {

TEST(TemporaryFolder, LeavesNothingBehind) {
  std::filesystem::path path;
  {
    const TemporaryFolder folder;
    path = folder.path();
    WriteTestFile(folder / "a", std::string("x\0y", 3));
    EXPECT_EQ(ReadTestFile(folder / "a"), std::string("x\0y", 3));
  }
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(TemporaryFolder, IsNotShared) {
  const TemporaryFolder a, b;
  EXPECT_NE(a.path(), b.path());
}

}  // namespace
}  // namespace duet::test

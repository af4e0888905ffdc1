#include "tests/support/data_folder.h"

#include <stdlib.h>

#include "gtest/gtest.h"
#include "tests/support/temporary_folder.h"

namespace duet::test {
namespace {

TEST(FindData, LooksWhereTheEnvironmentSays) {
  const TemporaryFolder folder;
  WriteTestFile(folder / "a", "");
  ASSERT_EQ(setenv("DUET_DATA_DIR", folder.path().c_str(), 1), 0);
  EXPECT_EQ(FindData("a"), folder / "a");
  EXPECT_EQ(FindData("b"), std::nullopt);
  unsetenv("DUET_DATA_DIR");
}

TEST(FindData, FindsNothingWhereThereIsNothing) {
  ASSERT_EQ(setenv("DUET_DATA_DIR", "/no/such/folder", 1), 0);
  EXPECT_EQ(FindData("a"), std::nullopt);
  unsetenv("DUET_DATA_DIR");
}

}  // namespace
}  // namespace duet::test

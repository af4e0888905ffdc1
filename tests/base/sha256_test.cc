#include "model/base/sha256.h"

#include <cstddef>
#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/status_matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::base {
namespace {

// Test vectors of FIPS 180-2, appendix B.
TEST(Sha256, PublishedVectors) {
  EXPECT_EQ(Sha256Hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(Sha256Hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(Sha256Hex(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, OfAFileEqualsThatOfItsContent) {
  const test::TemporaryFolder folder;
  for (const std::size_t size : {0, 1, 262144, 262145, 1000000}) {
    const std::string content(size, 'a');
    test::WriteTestFile(folder / "file", content);
    EXPECT_EQ(Sha256HexOfFile(folder / "file").value_or(""), Sha256Hex(content)) << size;
  }
  EXPECT_THAT(Sha256HexOfFile(folder / "none"),
              test::StatusIs(absl::StatusCode::kPermissionDenied, testing::HasSubstr("none: ")));
  EXPECT_THAT(Sha256HexOfFile(folder.path()),
              test::StatusIs(absl::StatusCode::kDataLoss, testing::HasSubstr("cannot be read")));
}

TEST(Sha256, OfAFileCanBeStopped) {
  const test::TemporaryFolder folder;
  test::WriteTestFile(folder / "file", std::string(1000000, 'a'));
  int blocks = 0;
  EXPECT_THAT(Sha256HexOfFile(folder / "file", [&blocks] { return ++blocks > 2; }),
              test::StatusIs(absl::StatusCode::kCancelled, testing::HasSubstr("file: stopped")));
  EXPECT_EQ(blocks, 3);
}

}  // namespace
}  // namespace duet::base

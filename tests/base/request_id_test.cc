#include "model/base/request_id.h"

#include <string>

#include "absl/strings/str_cat.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"

namespace duet::base {
namespace {

using ::testing::HasSubstr;

TEST(RequestIdTest, AcceptsPrintableTextWithoutSpaces) {
  EXPECT_TRUE(IsRequestId("a"));
  EXPECT_TRUE(IsRequestId("shot-42/take.3#7"));
  EXPECT_TRUE(IsRequestId(std::string(128, 'x')));
}

TEST(RequestIdTest, RefusesWhatWouldSpoilALog) {
  EXPECT_FALSE(IsRequestId(""));
  EXPECT_FALSE(IsRequestId(std::string(129, 'x')));
  EXPECT_FALSE(IsRequestId("two words"));
  EXPECT_FALSE(IsRequestId("line\nbreak"));
  EXPECT_FALSE(IsRequestId("caf\xc3\xa9"));
}

TEST(RequestIdTest, AnErrorSaysWhatCame) {
  EXPECT_THAT(CheckRequestId("job-7"), IsOk());
  EXPECT_THAT(
      CheckRequestId("a\nb"),
      StatusIs(absl::StatusCode::kInvalidArgument,
               R"(expected 1 to 128 printable ASCII characters without spaces, got "a\nb")"));
  EXPECT_THAT(CheckRequestId(std::string(129, 'x')),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("...\" of 129 bytes")));
}

}  // namespace
}  // namespace duet::base

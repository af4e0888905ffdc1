#include "tests/support/status_matchers.h"

#include "gtest/gtest.h"

namespace duet::test {
namespace {

using ::testing::_;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(StatusMatchers, IsOkTakesStatusAndStatusOr) {
  EXPECT_THAT(absl::OkStatus(), IsOk());
  EXPECT_THAT(absl::StatusOr<int>(3), IsOk());
  EXPECT_THAT(absl::InternalError("x"), Not(IsOk()));
  EXPECT_THAT(absl::StatusOr<int>(absl::InternalError("x")), Not(IsOk()));
}

TEST(StatusMatchers, StatusIsComparesCodeAndMessage) {
  const absl::StatusOr<int> failed = absl::NotFoundError("model \"x\"");
  EXPECT_THAT(failed, StatusIs(absl::StatusCode::kNotFound, HasSubstr("x")));
  EXPECT_THAT(failed, Not(StatusIs(absl::StatusCode::kInternal, _)));
  EXPECT_THAT(failed, Not(StatusIs(absl::StatusCode::kNotFound, HasSubstr("y"))));
}

}  // namespace
}  // namespace duet::test

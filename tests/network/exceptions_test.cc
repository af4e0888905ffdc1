#include "model/network/exceptions.h"

#include <c10/util/Exception.h>
#include <gmock/gmock.h>

#include <new>
#include <stdexcept>

#include "tests/support/matchers.h"

namespace duet::network {
namespace {

TEST(CatchExceptionsTest, ReturnsTheStatusOfTheWork) {
  EXPECT_THAT(CatchExceptions([] { return absl::OkStatus(); }), IsOk());
  EXPECT_THAT(CatchExceptions([] { return absl::NotFoundError("no data"); }),
              StatusIs(absl::StatusCode::kNotFound, "no data"));
}

TEST(CatchExceptionsTest, ReturnsLibTorchsMessageWithoutItsStackTrace) {
  const auto throws = []() -> absl::Status { TORCH_CHECK(false, "no such shape"); };
  EXPECT_THAT(CatchExceptions(throws), StatusIs(absl::StatusCode::kInternal,
                                                AllOf(HasSubstr("LibTorch failed: no such shape"),
                                                      Not(HasSubstr("frame #")))));
}

}  // namespace
}  // namespace duet::network

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "absl/strings/str_cat.h"
#include "server/common/error_details.h"
#include "server/service/refusals.h"
#include "tests/server/support/refusal.h"
#include "tests/support/matchers.h"

namespace duet::server::service {
namespace {

using test::Decode;
using test::Refusal;

TEST(ViolationsTest, NoneIsOk) { EXPECT_THAT(Violations().ToStatus(), IsOk()); }

TEST(ViolationsTest, NamesEveryFieldInOrder) {
  Violations violations;
  violations.Malformed("a", "2", "1");
  violations.Malformed("b[3]", "a number", "nan");
  const Refusal refusal = Decode(violations.ToStatus());
  EXPECT_EQ(refusal.code, absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(refusal.violations, ElementsAre(Pair("a", "expected 2, got 1"),
                                              Pair("b[3]", "expected a number, got nan")));
  EXPECT_EQ(refusal.reason, "INVALID_REQUEST");
  EXPECT_EQ(refusal.message, "a: expected 2, got 1; b[3]: expected a number, got nan");
}

TEST(ViolationsTest, OnlyMismatchesAreAFailedPrecondition) {
  Violations violations;
  violations.Mismatch("leader.joint_names", "all joints", "none for head");
  const Refusal refusal = Decode(violations.ToStatus());
  EXPECT_EQ(refusal.code, absl::StatusCode::kFailedPrecondition);
  EXPECT_EQ(refusal.reason, "MODEL_MISMATCH");
}

TEST(ViolationsTest, AMalformedFieldOutweighsAMismatch) {
  Violations violations;
  violations.Mismatch("leader.joint_names", "all joints", "none for head");
  violations.Malformed("chunk_frames", "1", "0");
  const Refusal refusal = Decode(violations.ToStatus());
  EXPECT_EQ(refusal.code, absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(refusal.violations.size(), 2u);
}

TEST(ViolationsTest, ManyFitIntoTrailersAndAreCounted) {
  Violations violations;
  for (int i = 0; i < 1000; ++i) {
    violations.Malformed(absl::StrCat("field[", i, "]"), "y", std::string(1000, 'x'));
  }
  const grpc::Status status = common::ToGrpcStatus(violations.ToStatus());
  // As base64 and together with the message; clients take 8 KiB of trailers.
  EXPECT_LT(status.error_details().size() * 4 / 3 + status.error_message().size(), 6000u);
  const Refusal refusal = Decode(status);
  ASSERT_FALSE(refusal.violations.empty());
  EXPECT_EQ(refusal.violations.front().first, "field[0]");
  const std::size_t listed = refusal.violations.size() - 1;
  EXPECT_THAT(refusal.violations.back(),
              Pair("", absl::StrCat(1000 - listed, " further violations are not listed")));
  EXPECT_THAT(refusal.message, HasSubstr("and 998 more"));
}

}  // namespace
}  // namespace duet::server::service

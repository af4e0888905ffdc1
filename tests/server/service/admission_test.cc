#include "server/service/admission.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "tests/support/matchers.h"

namespace duet::server::service {
namespace {

using absl::StatusCode;
using ::testing::_;

AdmissionLimits Calls(std::size_t max_calls) {
  AdmissionLimits limits;
  limits.max_calls = max_calls;
  return limits;
}

TEST(AdmissionTest, AdmitsUpToItsLimitAndNobodyWhileItDrains) {
  Admission admission(Calls(2));
  admission.SetState(Admission::State::kServing);
  absl::StatusOr<ShareLease> first = admission.Admit("a");
  const absl::StatusOr<ShareLease> second = admission.Admit("a");
  EXPECT_THAT(second, IsOk());
  EXPECT_THAT(admission.Admit("a"), StatusIs(StatusCode::kResourceExhausted, _));
  EXPECT_EQ(admission.calls(), 2u);
  { const ShareLease gone = *std::move(first); }
  EXPECT_THAT(admission.Admit("a"), IsOk());
  admission.SetState(Admission::State::kDraining);
  EXPECT_THAT(admission.Admit("a"), StatusIs(StatusCode::kUnavailable, _));
  EXPECT_EQ(admission.calls(), 1u) << "who is in stays";
}

TEST(AdmissionTest, ReservesAQuarterForInteractiveCalls) {
  Admission admission(Calls(4));
  admission.SetState(Admission::State::kServing);
  std::vector<ShareLease> places;
  for (int i = 0; i < 4; ++i) {
    EXPECT_THAT(admission.CheckShare(batching::Priority::kBulk), IsOk()) << i;
    places.push_back(*admission.Admit("a"));
  }
  EXPECT_THAT(admission.CheckShare(batching::Priority::kInteractive), IsOk());
  EXPECT_THAT(admission.CheckShare(batching::Priority::kBulk),
              StatusIs(StatusCode::kResourceExhausted, HasSubstr("at most 3 of this priority")));
}

}  // namespace
}  // namespace duet::server::service

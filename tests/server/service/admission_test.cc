#include "server/service/admission.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "tests/server/support/refusal.h"
#include "tests/support/matchers.h"

namespace duet::server::service {
namespace {

using ::testing::_;

using absl::StatusCode;

AdmissionLimits Calls(std::size_t max_calls) {
  AdmissionLimits limits;
  limits.max_calls = max_calls;
  return limits;
}

TEST(AdmissionTest, AdmitsUpToItsLimitAndAgainWhenOneLeaves) {
  Admission admission(Calls(2));
  admission.SetState(Admission::State::kServing);
  absl::StatusOr<ShareLease> first = admission.Admit("a");
  absl::StatusOr<ShareLease> second = admission.Admit("a");
  EXPECT_THAT(second, IsOk());
  EXPECT_THAT(admission.Admit("a"), StatusIs(StatusCode::kResourceExhausted, _));
  EXPECT_EQ(admission.calls(), 2u);
  { const ShareLease gone = *std::move(first); }
  EXPECT_THAT(admission.Admit("a"), IsOk());
}

TEST(AdmissionTest, ReservesAQuarterForInteractiveCalls) {
  Admission admission(Calls(4));
  admission.SetState(Admission::State::kServing);
  std::vector<ShareLease> places;
  for (int i = 0; i < 3; ++i) {
    places.push_back(*admission.Admit("a"));
    EXPECT_THAT(admission.CheckShare(batching::Priority::kBulk), IsOk()) << i;
  }
  const absl::StatusOr<ShareLease> fourth = admission.Admit("a");
  ASSERT_THAT(fourth, IsOk());
  EXPECT_THAT(admission.CheckShare(batching::Priority::kInteractive), IsOk());
  EXPECT_THAT(admission.CheckShare(batching::Priority::kBulk),
              StatusIs(StatusCode::kResourceExhausted, HasSubstr("at most 3 of this priority")));
}

TEST(AdmissionTest, DrainingAdmitsNobodyButKeepsWhoIsIn) {
  Admission admission(Calls(4));
  admission.SetState(Admission::State::kServing);
  const absl::StatusOr<ShareLease> place = admission.Admit("a");
  admission.SetState(Admission::State::kDraining);
  EXPECT_THAT(admission.Admit("a"), StatusIs(StatusCode::kUnavailable, _));
  EXPECT_EQ(admission.calls(), 1u);
}

}  // namespace
}  // namespace duet::server::service

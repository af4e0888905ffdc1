#include "server/service/admission.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "tests/support/status_matchers.h"

namespace duet::server::service {
namespace {

using test::IsOk;
using test::StatusIs;

using ::testing::_;

using absl::StatusCode;

TEST(AdmissionTest, LoadsBeforeItServes) {
  Admission admission(4);
  EXPECT_THAT(admission.Admit(batching::Priority::kInteractive),
              StatusIs(StatusCode::kUnavailable, _));
  EXPECT_THAT(admission.CheckServing(), StatusIs(StatusCode::kUnavailable, _));
}

TEST(AdmissionTest, AdmitsUpToItsLimitAndAgainWhenOneLeaves) {
  Admission admission(2);
  admission.SetState(Admission::State::kServing);
  absl::StatusOr<AdmissionSlot> first = admission.Admit(batching::Priority::kInteractive);
  absl::StatusOr<AdmissionSlot> second = admission.Admit(batching::Priority::kInteractive);
  EXPECT_THAT(second, IsOk());
  EXPECT_THAT(admission.Admit(batching::Priority::kInteractive),
              StatusIs(StatusCode::kResourceExhausted, _));
  EXPECT_EQ(admission.calls(), 2u);
  { const AdmissionSlot gone = *std::move(first); }
  EXPECT_THAT(admission.Admit(batching::Priority::kInteractive), IsOk());
}

TEST(AdmissionTest, KeepsAQuarterFreeOfBulk) {
  Admission admission(4);
  admission.SetState(Admission::State::kServing);
  std::vector<AdmissionSlot> slots;
  for (int i = 0; i < 3; ++i) slots.push_back(*admission.Admit(batching::Priority::kBulk));
  EXPECT_THAT(admission.Admit(batching::Priority::kBulk),
              StatusIs(StatusCode::kResourceExhausted, _));
  EXPECT_THAT(admission.Admit(batching::Priority::kInteractive), IsOk());
}

TEST(AdmissionTest, ASlotCountsOnceHoweverItMoves) {
  Admission admission(4);
  admission.SetState(Admission::State::kServing);
  {
    AdmissionSlot first = *admission.Admit(batching::Priority::kInteractive);
    AdmissionSlot second = std::move(first);
    AdmissionSlot third;
    third = std::move(second);
    EXPECT_EQ(admission.calls(), 1u);
  }
  EXPECT_EQ(admission.calls(), 0u);
}

TEST(AdmissionTest, DrainingAdmitsNobodyButKeepsWhoIsIn) {
  Admission admission(4);
  admission.SetState(Admission::State::kServing);
  const absl::StatusOr<AdmissionSlot> slot = admission.Admit(batching::Priority::kInteractive);
  admission.SetState(Admission::State::kDraining);
  EXPECT_THAT(admission.Admit(batching::Priority::kInteractive),
              StatusIs(StatusCode::kUnavailable, _));
  EXPECT_EQ(admission.calls(), 1u);
}

}  // namespace
}  // namespace duet::server::service

#include "model/motion/reading_setting.h"

#include "absl/strings/cord.h"
#include "gtest/gtest.h"

namespace duet::motion {
namespace {

TEST(ReadingSetting, IsAttachedToTheError) {
  for (ReadingSetting setting :
       {ReadingSetting::kFrameRate, ReadingSetting::kMetresPerUnit, ReadingSetting::kJointMap}) {
    const absl::Status status = MendedBy(absl::InvalidArgumentError("no"), setting);
    EXPECT_EQ(status.message(), "no");
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
    EXPECT_EQ(MendingSetting(status), setting);
  }
}

TEST(ReadingSetting, IsAbsentIfNoSettingWouldHelp) {
  EXPECT_EQ(MendingSetting(absl::InvalidArgumentError("no")), std::nullopt);
  absl::Status other = absl::InvalidArgumentError("no");
  other.SetPayload("duet.motion.ReadingSetting", absl::Cord("of a later version"));
  EXPECT_EQ(MendingSetting(other), std::nullopt);
}

}  // namespace
}  // namespace duet::motion

#include "model/motion/reading_setting.h"

#include "absl/strings/cord.h"
#include "absl/strings/string_view.h"

namespace duet::motion {
namespace {

constexpr char kDetail[] = "duet.motion.ReadingSetting";

struct Name {
  ReadingSetting setting;
  absl::string_view name;
};
constexpr Name kNames[] = {{ReadingSetting::kFormat, "format"},
                           {ReadingSetting::kFrameRate, "frame_rate"},
                           {ReadingSetting::kMetresPerUnit, "metres_per_unit"},
                           {ReadingSetting::kJointMap, "joint_map"},
                           {ReadingSetting::kRigJointMap, "rig_joint_map"}};

}  // namespace

absl::Status MendedBy(absl::Status status, ReadingSetting setting) {
  for (const Name& entry : kNames) {
    if (entry.setting == setting) status.SetPayload(kDetail, absl::Cord(entry.name));
  }
  return status;
}

std::optional<ReadingSetting> MendingSetting(const absl::Status& status) {
  const auto detail = status.GetPayload(kDetail);
  if (!detail.has_value()) return std::nullopt;
  for (const Name& entry : kNames) {
    if (*detail == entry.name) return entry.setting;
  }
  return std::nullopt;
}

}  // namespace duet::motion

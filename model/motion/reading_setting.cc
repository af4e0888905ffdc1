#include "model/motion/reading_setting.h"

#include "absl/strings/cord.h"

namespace duet::motion {
namespace {

constexpr char kDetail[] = "duet.motion.ReadingSetting";

struct Name {
  ReadingSetting setting;
  absl::string_view name;
  absl::string_view field;
};
constexpr Name kNames[] = {{ReadingSetting::kFormat, "format", ""},
                           {ReadingSetting::kFrameRate, "frame_rate", "frame_rate_hz"},
                           {ReadingSetting::kMetresPerUnit, "metres_per_unit", "metres_per_unit"},
                           {ReadingSetting::kJointMap, "joint_map", "joint_map"},
                           {ReadingSetting::kRigJointMap, "rig_joint_map", ""}};

const Name* FindAttached(const absl::Status& status) {
  const auto detail = status.GetPayload(kDetail);
  if (!detail.has_value()) return nullptr;
  for (const Name& entry : kNames) {
    if (*detail == entry.name) return &entry;
  }
  return nullptr;
}

}  // namespace

absl::Status MendedBy(absl::Status status, ReadingSetting setting) {
  for (const Name& entry : kNames) {
    if (entry.setting == setting) status.SetPayload(kDetail, absl::Cord(entry.name));
  }
  return status;
}

std::optional<ReadingSetting> MendingSetting(const absl::Status& status) {
  const Name* const attached = FindAttached(status);
  return attached == nullptr ? std::nullopt : std::make_optional(attached->setting);
}

absl::string_view MendingField(const absl::Status& status) {
  const Name* const attached = FindAttached(status);
  return attached == nullptr ? "" : attached->field;
}

}  // namespace duet::motion

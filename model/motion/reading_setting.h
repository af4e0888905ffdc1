#ifndef DUET_MODEL_MOTION_READING_SETTING_H_
#define DUET_MODEL_MOTION_READING_SETTING_H_

#include <optional>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"

namespace duet::motion {

// The settings of a reader of motion files. kRigJointMap is the joint map of a file of which only
// the rig is used.
enum class ReadingSetting { kFormat, kFrameRate, kMetresPerUnit, kJointMap, kRigJointMap };

// Attaches to an error the setting that would fix it. A program can then name its own flag or field
// for that setting.
absl::Status MendedBy(absl::Status status, ReadingSetting setting);

// The setting that MendedBy attached; absent if no setting would help.
std::optional<ReadingSetting> MendingSetting(const absl::Status& status);

// The same as the name of a field, in a recipe and in Python; empty if no field would help.
absl::string_view MendingField(const absl::Status& status);

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_READING_SETTING_H_

#ifndef DUET_MODEL_MOTION_READING_SETTING_H_
#define DUET_MODEL_MOTION_READING_SETTING_H_

#include <optional>

#include "absl/status/status.h"

namespace duet::motion {

// What a reader of motion files can be told beside the file. kRigJointMap is the joint map of a
// file that is read for its rig alone.
enum class ReadingSetting { kFormat, kFrameRate, kMetresPerUnit, kJointMap, kRigJointMap };

// `status`, an error, with the setting that would mend it as a detail, for a program that knows how
// its user says that setting.
absl::Status MendedBy(absl::Status status, ReadingSetting setting);

// The setting of MendedBy; absent where nothing that can be told would help.
std::optional<ReadingSetting> MendingSetting(const absl::Status& status);

}  // namespace duet::motion

#endif  // DUET_MODEL_MOTION_READING_SETTING_H_

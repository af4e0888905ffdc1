#ifndef DUET_MODEL_FORMATS_ASF_AMC_IMPORT_H_
#define DUET_MODEL_FORMATS_ASF_AMC_IMPORT_H_

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/formats/asf/amc_motion.h"
#include "model/formats/asf/asf_skeleton.h"
#include "model/motion/clip.h"
#include "model/retargeting/character.h"
#include "model/retargeting/character_rig.h"

namespace duet::formats::asf {

struct AmcImportOptions : retargeting::CharacterOptions {
  // The files do not state a rate. If absent, 120 Hz, the rate of CMU's captures, with a note.
  std::optional<double> frame_rate_hz;
};

// Converts joint angles to the skeleton's joint positions by forward kinematics. A bone's name
// denotes the joint at its start (lfemur: the hip). The last bone of a limb has an end, "head.end".
//
// Errors: those of retargeting::ToClip, naming `source`.
absl::StatusOr<motion::Clip> FromAmc(const AsfSkeleton& skeleton, const AmcMotion& motion,
                                     absl::string_view source,
                                     const AmcImportOptions& options = {});

// Returns the rig of an .asf file, read by ToClip with this motion, to write in another format.
// Errors: those of FromAmc.
absl::StatusOr<retargeting::CharacterRig> AmcRig(const AsfSkeleton& skeleton,
                                                 const AmcMotion& motion, absl::string_view source,
                                                 const AmcImportOptions& options = {});

// Reads the skeleton in a motion's folder that has one of SkeletonNames.
// Errors: NOT_FOUND with these names; those of base::ReadFile and ParseAsf.
absl::StatusOr<AsfSkeleton> ReadSkeletonBeside(const std::filesystem::path& motion_file);

// The possible file names of a motion's skeleton, in order of preference: 01_02.asf, then 01.asf
// for 01_02.amc.
std::vector<std::string> SkeletonNames(absl::string_view motion_name);

}  // namespace duet::formats::asf

#endif  // DUET_MODEL_FORMATS_ASF_AMC_IMPORT_H_

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
  // Absent: 120, as CMU's captures have, with a note; the files do not say.
  std::optional<double> frame_rate_hz;
};

// Joint angles through forward kinematics to the skeleton's joint positions. A bone's name stands
// for the joint where it starts (lfemur: the hip); the last of a limb has an end, "head.end".
//
// Errors: INVALID_ARGUMENT naming `source`: what retargeting::ToClip refuses.
absl::StatusOr<motion::Clip> FromAmc(const AsfSkeleton& skeleton, const AmcMotion& motion,
                                     absl::string_view source,
                                     const AmcImportOptions& options = {});

// The rig of an .asf file as ToClip understands it with this motion, for writing in another format.
// Errors: those of FromAmc.
absl::StatusOr<retargeting::CharacterRig> AmcRig(const AsfSkeleton& skeleton,
                                                 const AmcMotion& motion, absl::string_view source,
                                                 const AmcImportOptions& options = {});

// The skeleton that lies beside a motion, under one of SkeletonNames.
// Errors: NOT_FOUND naming them; those of reading the file.
absl::StatusOr<AsfSkeleton> ReadSkeletonBeside(const std::filesystem::path& motion_file);

// Names under which the skeleton of a motion may lie beside it, the best first: 01_02.amc has
// 01_02.asf or 01.asf.
std::vector<std::string> SkeletonNames(absl::string_view motion_name);

}  // namespace duet::formats::asf

#endif  // DUET_MODEL_FORMATS_ASF_AMC_IMPORT_H_

#ifndef DUET_CONTRIB_FORMATS_FBX_FBX_CONVERSION_H_
#define DUET_CONTRIB_FORMATS_FBX_FBX_CONVERSION_H_

#include <string>

#include "absl/status/statusor.h"

namespace duet::contrib::formats::fbx {

// Converts an FBX file to a binary glTF in metres, y up, by the unit and axis that the file states:
// its nodes, skinned meshes with their diffuse colours, and an animation for each take, sampled at
// the file's rate.
//
// Errors: INVALID_ARGUMENT for a file that assimp rejects, and for more than Duet reads.
absl::StatusOr<std::string> ConvertFbx(const std::string& content);

}  // namespace duet::contrib::formats::fbx

#endif  // DUET_CONTRIB_FORMATS_FBX_FBX_CONVERSION_H_

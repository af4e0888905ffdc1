#ifndef DUET_MODEL_FORMATS_FOLLOWER_RIG_H_
#define DUET_MODEL_FORMATS_FOLLOWER_RIG_H_

#include <filesystem>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "model/formats/motion_file.h"
#include "model/motion/clip.h"

namespace duet::formats {

// A BVH, AMC (beside its .asf) or glTF whose rig a follower is written onto, and how that file is
// read.
struct FollowerRig {
  std::filesystem::path file;
  ReadOptions reading;
};

// What has a rig, and what a follower on a rig is written as.
inline constexpr char kRigExtensions[] = "a .bvh, .amc, .glb or .gltf";
inline constexpr char kRigOutputExtensions[] = ".bvh, .glb or .gltf";

// Whether a follower on a rig of the format `rig` can be written in the format `written`.
bool FitsRig(Format written, Format rig);

// Whether the rig can be read; it need not be animated. Errors: those of reading it.
absl::Status CheckRig(const FollowerRig& rig);

// The follower on that rig. In its own format the rig keeps all of its file but the motion
// (bvh::OntoBvhRig, gltf::OntoGltfRig); in another one it keeps names, hierarchy and bone lengths
// (bvh::ToBvh, gltf::FormatCharacter).
//
// Errors: those of reading the rig; INVALID_ARGUMENT for a rig that cannot be the follower's, or a
//         format that FitsRig does not accept.
absl::StatusOr<std::string> FormatOntoRig(const motion::Clip& follower, const FollowerRig& rig,
                                          Format format, const WriteOptions& options = {});

}  // namespace duet::formats

#endif  // DUET_MODEL_FORMATS_FOLLOWER_RIG_H_

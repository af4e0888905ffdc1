#ifndef DUET_MODEL_FORMATS_FOLLOWER_RIG_H_
#define DUET_MODEL_FORMATS_FOLLOWER_RIG_H_

#include <filesystem>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "model/formats/motion_file.h"
#include "model/motion/clip.h"

namespace duet::formats {

// A BVH, AMC (with its .asf), FBX or glTF whose rig the follower is written onto, and the options
// to read it.
struct FollowerRig {
  std::filesystem::path file;
  ReadOptions reading;
};

// The formats that have a rig, and those of a follower on a rig.
inline constexpr char kRigExtensions[] = "a .bvh, .amc, .fbx, .glb or .gltf";
inline constexpr char kRigOutputExtensions[] = ".bvh, .glb or .gltf";

// Whether a follower on a rig of the format `rig` can be written in the format `written`.
bool FitsRig(Format written, Format rig);

// Checks that the rig can be read; it need not be animated. Adds to rig.reading.notes, like every
// reader. Errors: those of reading it.
absl::Status CheckRig(const FollowerRig& rig);

// Formats the follower on the rig. In the rig's own format, everything in its file except the
// motion is kept (bvh::OntoBvhRig, gltf::OntoGltfRig). In another format, names, hierarchy and bone
// lengths are kept (bvh::ToBvh, gltf::FormatCharacter); from FBX to glTF, skins and meshes too
// (fbx::OntoFbxRig). Adds to rig.reading.notes, like every reader.
//
// Errors: those of reading the rig; INVALID_ARGUMENT for an unsuitable rig, or a format that
//         FitsRig does not accept.
absl::StatusOr<std::string> FormatOntoRig(const motion::Clip& follower, const FollowerRig& rig,
                                          Format format, const WriteOptions& options = {});

// The unit in which FormatOntoRig writes a BVH: the rig's own if it is a BVH, or else that of
// `options`. Errors: those of reading the rig.
absl::StatusOr<double> BvhUnitOnRig(const FollowerRig& rig, const WriteOptions& options);

}  // namespace duet::formats

#endif  // DUET_MODEL_FORMATS_FOLLOWER_RIG_H_

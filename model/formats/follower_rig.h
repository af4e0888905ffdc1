#ifndef DUET_MODEL_FORMATS_FOLLOWER_RIG_H_
#define DUET_MODEL_FORMATS_FOLLOWER_RIG_H_

#include <filesystem>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "model/formats/motion_file.h"
#include "model/motion/clip.h"

namespace duet::formats {

// A BVH or glTF whose rig the follower is written onto, and the options to read it.
struct FollowerRig {
  std::filesystem::path file;
  ReadOptions reading;
};

// The formats that have a rig.
inline constexpr char kRigExtensions[] = "a .bvh, .glb or .gltf";
bool HasRig(Format format);

// Whether a follower on a rig of the format `rig` can be written in the format `written`: a BVH as
// a BVH, a .glb or .gltf as either of the two.
bool FitsRig(Format written, Format rig);

// Formats the follower on the rig: everything in the rig's file except the motion is kept
// (bvh::OntoBvhRig, gltf::OntoGltfRig). Reports to rig.reading.report, like every reader.
//
// Errors: those of reading the rig; INVALID_ARGUMENT for an unsuitable rig, or a format that
//         FitsRig does not accept.
absl::StatusOr<std::string> FormatOntoRig(const motion::Clip& follower, const FollowerRig& rig,
                                          Format format);

}  // namespace duet::formats

#endif  // DUET_MODEL_FORMATS_FOLLOWER_RIG_H_

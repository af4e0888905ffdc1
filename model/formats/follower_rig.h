#ifndef DUET_MODEL_FORMATS_FOLLOWER_RIG_H_
#define DUET_MODEL_FORMATS_FOLLOWER_RIG_H_

#include <filesystem>
#include <string>

#include "absl/status/statusor.h"
#include "model/formats/motion_file.h"
#include "model/motion/clip.h"

namespace duet::formats {

// A BVH or glTF whose rig a follower is written onto, and how that file is read.
struct FollowerRig {
  std::filesystem::path file;
  ReadOptions reading;
};

// Whether a rig of one format may be written in another: as BVH on a BVH's, as glTF of either kind
// on a glTF's.
bool FitsRig(Format written, Format rig);

// The follower on that rig (bvh::OntoBvhRig, gltf::OntoGltfRig); of `options`, how keys are written
// counts.
// Errors: those of reading the rig; INVALID_ARGUMENT for a rig that cannot be the follower's, or
// one
//         that `format` does not fit.
absl::StatusOr<std::string> FormatOntoRig(const motion::Clip& follower, const FollowerRig& rig,
                                          Format format, const WriteOptions& options = {});

}  // namespace duet::formats

#endif  // DUET_MODEL_FORMATS_FOLLOWER_RIG_H_

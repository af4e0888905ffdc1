#ifndef DUET_MODEL_FORMATS_GLTF_GLTF_EXPORT_H_
#define DUET_MODEL_FORMATS_GLTF_GLTF_EXPORT_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "model/motion/clip.h"
#include "model/motion/provenance.h"
#include "model/motion/skeleton.h"

namespace duet::formats::gltf {

enum class GltfContainer {
  kBinary,  // .glb
  kText     // .gltf, with its buffer as base64 inside
};

// One person or a leader and a follower as skinned mannequins with a skeleton each and one
// animation of all: metres, y up, in the clips' world, everybody at rest in the T pose of MakeRig
// with the feet on the floor at the origin. Joints are nodes of the skeleton's names. Every joint
// stands exactly where its clip has it: bones turn, and those whose length changes also move. What
// `provenance` says is in the scene's extras; it may be null.
//
// Errors: INVALID_ARGUMENT when there are not one or two people, their joints are not the
//         skeleton's, they differ in frames or rate, or a position is not finite.
absl::StatusOr<std::string> FormatGltf(const std::vector<motion::Clip>& people,
                                       const motion::Skeleton& skeleton,
                                       const motion::Provenance* provenance,
                                       GltfContainer container);

}  // namespace duet::formats::gltf

#endif  // DUET_MODEL_FORMATS_GLTF_GLTF_EXPORT_H_

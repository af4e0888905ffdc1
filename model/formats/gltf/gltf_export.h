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

// Writes one person, or a leader and a follower, as skinned mannequins. Each has a skeleton; all
// share one animation. Units are metres, y up, in the clips' world. The rest pose is the T pose of
// MakeRig with the feet on the floor at the origin. Joints are nodes with the skeleton's names.
// Every joint is exactly at its position in the clip: bones rotate, and those whose length changes
// are also translated. The scene's extras hold `provenance`, which may be null.
//
// Errors: INVALID_ARGUMENT if there are not one or two people, their joints are not the
//         skeleton's, they differ in frames or rate, or a position is not finite.
absl::StatusOr<std::string> FormatGltf(const std::vector<motion::Clip>& people,
                                       const motion::Skeleton& skeleton,
                                       const motion::Provenance* provenance,
                                       GltfContainer container);

}  // namespace duet::formats::gltf

#endif  // DUET_MODEL_FORMATS_GLTF_GLTF_EXPORT_H_

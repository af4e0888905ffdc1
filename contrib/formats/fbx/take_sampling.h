#ifndef DUET_CONTRIB_FORMATS_FBX_TAKE_SAMPLING_H_
#define DUET_CONTRIB_FORMATS_FBX_TAKE_SAMPLING_H_

#include <vector>

#include "absl/status/statusor.h"
#include "assimp/scene.h"
#include "contrib/formats/fbx/node_tree.h"
#include "model/retargeting/affine.h"

namespace duet::contrib::formats::fbx {

// The motion of one node in a take, in its parent's axes.
struct Track {
  int node = 0;
  std::vector<retargeting::Parts> frames;
};

// Samples the nodes that a take moves, from its first key to its last. FBX interpolates the angles
// of a joint; sampling at the file's own rate therefore keeps every frame of a baked motion
// exactly.
//
// Errors: INVALID_ARGUMENT if the take is too long, or moves a node whose name another node has
//         (assimp would merge their motions).
absl::StatusOr<std::vector<Track>> SampleTake(const aiAnimation& take, const NodeTree& tree,
                                              double frame_rate_hz);

}  // namespace duet::contrib::formats::fbx

#endif  // DUET_CONTRIB_FORMATS_FBX_TAKE_SAMPLING_H_

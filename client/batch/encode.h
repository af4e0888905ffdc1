#ifndef DUET_CLIENT_BATCH_ENCODE_H_
#define DUET_CLIENT_BATCH_ENCODE_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/batch/recipe.h"
#include "model/motion/clip.h"
#include "model/motion/skeleton.h"

namespace duet::client::batch {

// A file of a pair.
struct EncodedFile {
  std::string ending;  // ".npy", ".leader.bvh"
  std::string content;
};

// A pair at the frame rate of the output's layout, where that has one of its own.
motion::ClipPair AtOutputRate(motion::ClipPair pair, const Output& output);

// The files that such a pair has: two of BVH, one of any other format; of a layout of captures one,
// with the leader on its side. INVALID_ARGUMENT for a pair that no file can hold.
absl::StatusOr<std::vector<EncodedFile>> Encode(const Output& output, formats::Side leader_side,
                                                const motion::ClipPair& pair,
                                                const motion::Skeleton& skeleton);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_ENCODE_H_

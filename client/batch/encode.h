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

// What follows an item's name in the names of its files of a format.
std::vector<std::string> EndingsOf(v1::Format format);

// The pair at the frame rate of the recipe, if it states one. Both people have the same number of
// frames before and after.
motion::ClipPair AtOutputRate(motion::ClipPair pair, const v1::Output& output);

// The files of a pair: two for BVH, one for any other format. INVALID_ARGUMENT for a pair that the
// format cannot hold.
absl::StatusOr<std::vector<EncodedFile>> Encode(const v1::Output& output,
                                                const motion::ClipPair& pair,
                                                const motion::Skeleton& skeleton);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_ENCODE_H_

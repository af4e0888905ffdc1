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

// The files that a pair has in a format: two of BVH, one of any other. INVALID_ARGUMENT for a pair
// that no file can hold.
absl::StatusOr<std::vector<EncodedFile>> Encode(Format format, const motion::ClipPair& pair,
                                                const motion::Skeleton& skeleton);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_ENCODE_H_

#ifndef DUET_MODEL_DATASET_PAIR_TEXT_H_
#define DUET_MODEL_DATASET_PAIR_TEXT_H_

#include <string_view>

#include "absl/status/statusor.h"
#include "model/dataset/layout.h"
#include "model/motion/clip.h"

namespace duet {

// The two people of a file as they are written, before roles are known.
struct PeoplePair {
  Clip left;   // written first
  Clip right;  // written second
};

// Parses SBU's line layout for any number of joints: a frame number, then (x, y, z) of every joint
// of the left person, then of the right one, separated by commas. World metres come out.
// Errors: INVALID_ARGUMENT naming the line, what came and what was wanted: a wrong count, a value
// that is no finite number, fewer than 2 frames.
absl::StatusOr<PeoplePair> ParsePairText(std::string_view text, const DatasetLayout& layout);

}  // namespace duet

#endif  // DUET_MODEL_DATASET_PAIR_TEXT_H_

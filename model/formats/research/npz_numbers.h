#ifndef DUET_MODEL_FORMATS_RESEARCH_NPZ_NUMBERS_H_
#define DUET_MODEL_FORMATS_RESEARCH_NPZ_NUMBERS_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/formats/research/npz_archive.h"
#include "model/motion/motion_limits.h"

namespace duet::formats::research {

// An array of an archive as numbers in C order.
struct NpzNumbers {
  std::string name;  // "walk.npz: poses", for messages
  std::vector<int> shape;
  std::vector<double> values;
};

// Errors: those of NpzArchive::Read and flat::NpyNumbers; INVALID_ARGUMENT if a value is not finite
// or beyond `most`.
absl::StatusOr<NpzNumbers> ReadNumbers(const NpzArchive& archive, absl::string_view name,
                                       double most = motion::kMaxCoordinate);

// INVALID_ARGUMENT "name: shape: expected ..., got ...".
absl::Status WrongShape(const NpzNumbers& numbers, absl::string_view expected);

}  // namespace duet::formats::research

#endif  // DUET_MODEL_FORMATS_RESEARCH_NPZ_NUMBERS_H_

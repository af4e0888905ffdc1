#ifndef DUET_MODEL_CHECKPOINT_SAFETENSORS_H_
#define DUET_MODEL_CHECKPOINT_SAFETENSORS_H_

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/types/span.h"

namespace duet::checkpoint {

// A float32 tensor in memory.
struct Tensor {
  std::string name;
  std::vector<int64_t> shape;
  std::vector<float> values;  // row-major
};

// A tensor that a checkpoint must contain, float32.
struct TensorSpec {
  std::string name;
  std::vector<int64_t> shape;
};

// Reads and writes the published safetensors format (data only: an 8-byte little-endian header
// length, a JSON header, the tensors' bytes). Accepts a strict subset of it: see safetensors.cc.
// Errors: INVALID_ARGUMENT naming the tensor and what was expected; DATA_LOSS for truncation.
absl::StatusOr<std::vector<Tensor>> ParseSafetensors(std::string_view bytes);
std::string SerializeSafetensors(absl::Span<const Tensor> tensors,
                                 const std::map<std::string, std::string>& metadata = {});

}  // namespace duet::checkpoint

#endif  // DUET_MODEL_CHECKPOINT_SAFETENSORS_H_

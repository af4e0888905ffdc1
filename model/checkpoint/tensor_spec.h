#ifndef DUET_MODEL_CHECKPOINT_TENSOR_SPEC_H_
#define DUET_MODEL_CHECKPOINT_TENSOR_SPEC_H_

#include <cstdint>
#include <string>
#include <vector>

namespace duet::checkpoint {

// A tensor that a checkpoint must contain, float32.
struct TensorSpec {
  std::string name;
  std::vector<int64_t> shape;
};

}  // namespace duet::checkpoint

#endif  // DUET_MODEL_CHECKPOINT_TENSOR_SPEC_H_

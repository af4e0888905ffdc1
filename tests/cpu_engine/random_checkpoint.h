#ifndef DUET_TESTS_CPU_ENGINE_RANDOM_CHECKPOINT_H_
#define DUET_TESTS_CPU_ENGINE_RANDOM_CHECKPOINT_H_

#include <cmath>
#include <cstdint>
#include <utility>

#include "model/base/random.h"
#include "model/checkpoint/checkpoint.h"

namespace duet::cpu_engine {

// A checkpoint with random weights within +-1/sqrt(inputs), as training starts with, so that a
// network of any width does not saturate.
inline checkpoint::Checkpoint RandomCheckpoint(checkpoint::Manifest manifest, uint64_t seed) {
  checkpoint::Checkpoint checkpoint{std::move(manifest), {}};
  base::Random random(seed);
  for (const checkpoint::TensorSpec& spec : ExpectedTensors(checkpoint.manifest)) {
    checkpoint::Tensor tensor{spec.name, spec.shape, {}};
    std::size_t count = 1;
    for (const int64_t size : spec.shape) count *= static_cast<std::size_t>(size);
    const double bound = 1 / std::sqrt(static_cast<double>(spec.shape.back()));
    for (std::size_t i = 0; i < count; ++i) {
      tensor.values.push_back(static_cast<float>(random.Uniform(-bound, bound)));
    }
    checkpoint.tensors.push_back(std::move(tensor));
  }
  return checkpoint;
}

}  // namespace duet::cpu_engine

#endif  // DUET_TESTS_CPU_ENGINE_RANDOM_CHECKPOINT_H_

#ifndef DUET_MODEL_ENGINE_SAMPLING_H_
#define DUET_MODEL_ENGINE_SAMPLING_H_

#include <cstdint>

namespace duet::engine {

// Which of a model's answers is wanted. A model that does not sample (ModelDescription::samples)
// has one answer and reads none of this.
struct Sampling {
  // The same request with the same seed has the same answer on the same engine.
  uint64_t seed = 0;
  // 0: the typical answer; 1: as varied as people are. In [0, 2].
  float variety = 1;
};

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_SAMPLING_H_

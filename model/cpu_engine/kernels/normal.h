#ifndef DUET_MODEL_CPU_ENGINE_KERNELS_NORMAL_H_
#define DUET_MODEL_CPU_ENGINE_KERNELS_NORMAL_H_

#include <cstddef>

namespace duet::cpu_engine::kernels {

// Computes standard normal numbers from pairs of uniform ones in (0, 1). They equal those of
// base::Random::StandardNormal to one or two units in the last place. Shapes: uniform [count, 2],
// out [count]. Source: Box, Muller 1958.
void StandardNormals(std::ptrdiff_t count, const double* uniform, float* out);

}  // namespace duet::cpu_engine::kernels

#endif  // DUET_MODEL_CPU_ENGINE_KERNELS_NORMAL_H_

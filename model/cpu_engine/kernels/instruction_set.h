#ifndef DUET_MODEL_CPU_ENGINE_KERNELS_INSTRUCTION_SET_H_
#define DUET_MODEL_CPU_ENGINE_KERNELS_INSTRUCTION_SET_H_

#include <string>

namespace duet::cpu_engine::kernels {

// The instruction set for which the kernels that run here were compiled, such as "AVX-512", "AVX2"
// or "NEON". Different ones add in different orders, so that results differ by rounding.
std::string InstructionSet();

}  // namespace duet::cpu_engine::kernels

#endif  // DUET_MODEL_CPU_ENGINE_KERNELS_INSTRUCTION_SET_H_

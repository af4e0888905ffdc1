#include "model/cpu_engine/kernels/instruction_set.h"

#include <hwy/targets.h>

namespace duet::cpu_engine::kernels {

std::string InstructionSet() {
  const int64_t usable = hwy::SupportedTargets() & HWY_TARGETS;
  const std::string name = hwy::TargetName(usable & -usable);  // the lowest bit is the best
  // AVX3, AVX3_ZEN4 and others: all have vectors of 512 bits.
  return name.rfind("AVX3", 0) == 0 ? "AVX-512" : name;
}

}  // namespace duet::cpu_engine::kernels

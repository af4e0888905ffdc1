#ifndef DUET_TESTS_CPU_ENGINE_KERNELS_AMX_EMULATOR_H_
#define DUET_TESTS_CPU_ENGINE_KERNELS_AMX_EMULATOR_H_

#include <cstdint>

namespace duet::cpu_engine::kernels {

// Emulates the instructions of AMX-BF16 during its lifetime, on a processor without them (Intel SDM
// 2, LDTILECFG to TDPBF16PS): each is an illegal instruction, and a signal handler decodes and
// executes it. An instruction that a processor with AMX would reject, with an unconfigured tile or
// with shapes that do not match, ends the process, as on that processor.
//
// At most one exists at a time, on one thread. x86-64 only.
class AmxEmulator {
 public:
  AmxEmulator();
  ~AmxEmulator();
  AmxEmulator(const AmxEmulator&) = delete;
  AmxEmulator& operator=(const AmxEmulator&) = delete;

  // Number of emulated instructions so far; 0 if the processor has the instructions.
  int64_t instructions() const;
  // Whether tiles are configured and not released.
  bool in_use() const;
};

}  // namespace duet::cpu_engine::kernels

#endif  // DUET_TESTS_CPU_ENGINE_KERNELS_AMX_EMULATOR_H_

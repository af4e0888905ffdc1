#ifndef DUET_TESTS_CPU_ENGINE_KERNELS_AMX_EMULATOR_H_
#define DUET_TESTS_CPU_ENGINE_KERNELS_AMX_EMULATOR_H_

#include <cstdint>

namespace duet::cpu_engine::kernels {

// While one lives, the instructions of AMX-BF16 do on this processor what its manual says they do
// (Intel SDM 2, LDTILECFG to TDPBF16PS), if it has none of its own: each is an illegal instruction
// that a signal's handler reads and does. An instruction that a processor with AMX would refuse, an
// unshaped tile or shapes that do not fit each other, ends the process as it would there.
//
// One at a time, on one thread. x86-64 alone.
class AmxEmulator {
 public:
  AmxEmulator();
  ~AmxEmulator();
  AmxEmulator(const AmxEmulator&) = delete;
  AmxEmulator& operator=(const AmxEmulator&) = delete;

  // Instructions done here so far; 0 where the processor does them itself.
  int64_t instructions() const;
  // Whether tiles are in use: shaped, and not released since.
  bool in_use() const;
};

}  // namespace duet::cpu_engine::kernels

#endif  // DUET_TESTS_CPU_ENGINE_KERNELS_AMX_EMULATOR_H_

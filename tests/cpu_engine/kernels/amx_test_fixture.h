#ifndef DUET_TESTS_CPU_ENGINE_KERNELS_AMX_TEST_FIXTURE_H_
#define DUET_TESTS_CPU_ENGINE_KERNELS_AMX_TEST_FIXTURE_H_

#include <gtest/gtest.h>

#include <optional>

#include "model/cpu_engine/kernels/gemm_bf16.h"
#include "model/cpu_engine/kernels/gemm_bf16_amx.h"
#include "tests/cpu_engine/kernels/amx_emulator.h"

namespace duet::cpu_engine::kernels {

// Runs products in bfloat16 in tiles: with the processor's instructions if it has them, else
// emulated. The code between tile instructions requires AVX-512 BF16, which every processor with
// tiles has. Without it HasAmx() is false and the tests are skipped.
class AmxTest : public ::testing::Test {
 public:
  ~AmxTest() override { ChooseBf16Product(Bf16Product::kBest); }

 protected:
  void SetUp() override {
    if (!HasBf16()) GTEST_SKIP() << kNeverHere;
    if (!HasAmx()) emulator_.emplace();
    ChooseBf16Product(Bf16Product::kAmx);
  }

  // Whether products used tiles and released them, as far as this can be observed.
  bool UsedTiles() const { return !emulator_ || emulator_->instructions() > 0; }
  bool ReleasedTiles() const { return !emulator_ || !emulator_->in_use(); }

 private:
  static constexpr char kNeverHere[] =
      "products in tiles are never made on this processor: it lacks AVX-512 BF16, which they use "
      "besides tiles; its own products are tested by the other tests";

  std::optional<AmxEmulator> emulator_;
};

}  // namespace duet::cpu_engine::kernels

#endif  // DUET_TESTS_CPU_ENGINE_KERNELS_AMX_TEST_FIXTURE_H_

#ifndef DUET_TESTS_CPU_ENGINE_KERNELS_EVERY_TARGET_H_
#define DUET_TESTS_CPU_ENGINE_KERNELS_EVERY_TARGET_H_

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cstdint>
#include <vector>

#include "model/base/random.h"

namespace duet::cpu_engine::kernels {

// Runs its tests once with each instruction set that this processor has, the plainest included.
class EveryTarget : public ::testing::TestWithParam<int64_t> {
 protected:
  EveryTarget() {
    hwy::SetSupportedTargetsForTest(GetParam());
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
  ~EveryTarget() override {
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }

  // In [-size, size].
  std::vector<float> Values(int count, float size = 1) {
    std::vector<float> values;
    for (int i = 0; i < count; ++i) {
      values.push_back(static_cast<float>(random_.Uniform(-size, size)));
    }
    return values;
  }

 private:
  base::Random random_{7};
};

// AVX-512, AVX2, SSE4 and none: what the kernels are compiled for and this processor has.
inline std::vector<int64_t> CompiledTargets() {
  std::vector<int64_t> targets;
  for (const int64_t target : {HWY_AVX3, HWY_AVX2, HWY_SSE4}) {
    if ((hwy::SupportedTargets() & target) != 0) targets.push_back(target);
  }
  targets.push_back(HWY_STATIC_TARGET);
  return targets;
}

#define DUET_FOR_EVERY_TARGET(suite)                                            \
  INSTANTIATE_TEST_SUITE_P(Targets, suite, ::testing::ValuesIn(CompiledTargets()), \
                           [](const auto& target) { return hwy::TargetName(target.param); })

}  // namespace duet::cpu_engine::kernels

#endif  // DUET_TESTS_CPU_ENGINE_KERNELS_EVERY_TARGET_H_

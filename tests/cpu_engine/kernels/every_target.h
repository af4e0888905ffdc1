#ifndef DUET_TESTS_CPU_ENGINE_KERNELS_EVERY_TARGET_H_
#define DUET_TESTS_CPU_ENGINE_KERNELS_EVERY_TARGET_H_

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "model/base/random.h"

namespace duet::cpu_engine::kernels {

// Runs its tests with every instruction set of this processor, including the baseline.
class EveryTarget : public ::testing::TestWithParam<int64_t> {
 public:
  EveryTarget();
  ~EveryTarget() override;

 protected:
  // `count` values in [-size, size].
  std::vector<float> Values(int count, float size = 1);

 private:
  base::Random random_{7};
};

// The instruction sets that the kernels are compiled for and this processor has.
std::vector<int64_t> CompiledTargets();
std::string TargetName(const ::testing::TestParamInfo<int64_t>& target);

#define DUET_FOR_EVERY_TARGET(suite) \
  INSTANTIATE_TEST_SUITE_P(Targets, suite, ::testing::ValuesIn(CompiledTargets()), TargetName)

}  // namespace duet::cpu_engine::kernels

#endif  // DUET_TESTS_CPU_ENGINE_KERNELS_EVERY_TARGET_H_

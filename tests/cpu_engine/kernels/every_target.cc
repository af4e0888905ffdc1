#include "tests/cpu_engine/kernels/every_target.h"

#include <hwy/detect_targets.h>
#include <hwy/targets.h>

#include "model/base/random.h"

namespace duet::cpu_engine::kernels {
namespace {

void Choose(int64_t targets) {
  hwy::SetSupportedTargetsForTest(targets);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace

EveryTarget::EveryTarget() { Choose(GetParam()); }
EveryTarget::~EveryTarget() { Choose(0); }

std::vector<float> EveryTarget::Values(int count, float size) {
  std::vector<float> values;
  for (int i = 0; i < count; ++i) {
    values.push_back(static_cast<float>(random_.Uniform(-size, size)));
  }
  return values;
}

std::vector<int64_t> CompiledTargets() {
  std::vector<int64_t> targets;
  for (const int64_t target : {HWY_AVX3, HWY_AVX2, HWY_SSE4}) {
    if ((hwy::SupportedTargets() & target) != 0) targets.push_back(target);
  }
  targets.push_back(HWY_STATIC_TARGET);
  return targets;
}

std::string TargetName(const ::testing::TestParamInfo<int64_t>& target) {
  return hwy::TargetName(target.param);
}

}  // namespace duet::cpu_engine::kernels

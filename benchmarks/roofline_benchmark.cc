// What one core of this machine could do at best, with nothing but arithmetic or nothing but reads:
// the bound that the engine's figures are held against.
#include <benchmark/benchmark.h>

#include <vector>

#include "model/cpu_engine/kernels/recurrent.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace {

void PerSecond(benchmark::State& state, const char* what, double count) {
  state.counters[what] = benchmark::Counter(count, benchmark::Counter::kIsIterationInvariantRate);
}

#if defined(__x86_64__)
// Sums that do not wait for one another: more than a multiply-add's latency times its throughput.
constexpr int kSums = 12;
constexpr int kRounds = 256;

__attribute__((target("avx512f"))) float MultiplyAdd512() {
  __m512 sums[kSums] = {};
  const __m512 factor = _mm512_set1_ps(0.5f);
  for (int round = 0; round < kRounds; ++round) {
    for (__m512& sum : sums) sum = _mm512_fmadd_ps(sum, factor, factor);
    benchmark::ClobberMemory();
  }
  for (int i = 1; i < kSums; ++i) sums[0] = _mm512_add_ps(sums[0], sums[i]);
  float total[16];
  _mm512_storeu_ps(total, sums[0]);
  return total[0];
}

__attribute__((target("avx2,fma"))) float MultiplyAdd256() {
  __m256 sums[kSums] = {};
  const __m256 factor = _mm256_set1_ps(0.5f);
  for (int round = 0; round < kRounds; ++round) {
    for (__m256& sum : sums) sum = _mm256_fmadd_ps(sum, factor, factor);
    benchmark::ClobberMemory();
  }
  for (int i = 1; i < kSums; ++i) sums[0] = _mm256_add_ps(sums[0], sums[i]);
  return _mm256_cvtss_f32(sums[0]);
}

void BM_MultiplyAddFloat32(benchmark::State& state) {
  const bool wide = __builtin_cpu_supports("avx512f");
  if (!wide && !__builtin_cpu_supports("fma")) {
    state.SkipWithError("this processor has no fused multiply-add");
    return;
  }
  for (auto _ : state) benchmark::DoNotOptimize(wide ? MultiplyAdd512() : MultiplyAdd256());
  PerSecond(state, "FLOP/s", 2.0 * (wide ? 16 : 8) * kSums * kRounds);
}
BENCHMARK(BM_MultiplyAddFloat32);
#endif

// Argument: kilobytes; 32 fit the first-level cache, 512 the second.
void BM_Read(benchmark::State& state) {
  const std::vector<uint64_t> words(static_cast<std::size_t>(state.range(0)) * 1024 / 8, 1);
  for (auto _ : state) {
    uint64_t sums[16] = {};
    for (std::size_t i = 0; i + 16 <= words.size(); i += 16) {
      for (std::size_t k = 0; k < 16; ++k) sums[k] ^= words[i + k];
    }
    benchmark::DoNotOptimize(sums);
  }
  state.SetBytesProcessed(state.iterations() * static_cast<int64_t>(words.size() * 8));
}
BENCHMARK(BM_Read)->Arg(32)->Arg(512)->Arg(65536);

// Nearly all of the attention's time that is no product.
void BM_Tanh(benchmark::State& state) {
  constexpr int kFrames = 45, kAttention = 128;
  const std::vector<float> encoded(kFrames * kAttention, 0.3f), query(kAttention, 0.1f),
      score(kAttention, 0.2f);
  std::vector<float> weights(kFrames);
  for (auto _ : state) {
    duet::cpu_engine::kernels::WeighFrames(
        {kFrames, kAttention, encoded.data(), query.data(), score.data(), weights.data()});
    benchmark::ClobberMemory();
  }
  PerSecond(state, "tanh/s", kFrames * kAttention);
}
BENCHMARK(BM_Tanh);

}  // namespace

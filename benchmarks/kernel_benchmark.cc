// The CPU engine's kernels one by one, and what the machine could do at best: a regression's
// address.
#include <benchmark/benchmark.h>

#include <vector>

#include "model/base/random.h"
#include "model/cpu_engine/kernels/packed_matrix.h"
#include "model/cpu_engine/kernels/recurrent.h"
#include "model/cpu_engine/kernels/transformer.h"

namespace duet::cpu_engine::kernels {
namespace {

std::vector<float> Values(std::ptrdiff_t count) {
  base::Random random(1);
  std::vector<float> values;
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    values.push_back(static_cast<float>(random.Uniform(-1, 1)));
  }
  return values;
}

void PerSecond(benchmark::State& state, const char* what, double count) {
  state.counters[what] = benchmark::Counter(count, benchmark::Counter::kIsIterationInvariantRate);
}

// Arguments: rows, inputs, outputs.
void Product(benchmark::State& state, Precision precision) {
  const int rows = static_cast<int>(state.range(0)), inputs = static_cast<int>(state.range(1)),
            outputs = static_cast<int>(state.range(2));
  const PackedMatrix matrix(Values(std::ptrdiff_t{outputs} * inputs), {}, outputs, inputs,
                            precision);
  const std::vector<float> x = Values(std::ptrdiff_t{rows} * inputs);
  std::vector<float> y(static_cast<std::size_t>(rows * outputs));
  for (auto _ : state) {
    matrix.Multiply(rows, x.data(), y.data());
    benchmark::ClobberMemory();
  }
  PerSecond(state, "FLOP/s", 2.0 * rows * inputs * outputs);
}
void Sizes(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"rows", "in", "out"});
  for (const int rows : {1, 4, 16, 32}) bench->Args({rows, 240, 1088});  // a decoder's step
  for (const int rows : {1, 16, 32}) bench->Args({rows, 40, 160});       // an encoder's step
  bench->Args({720, 480, 960});                                          // the decoder's values
  bench->Args({45, 160, 480})->Args({720, 160, 480})->Args({720, 480, 160});  // the transformer's
}
BENCHMARK_CAPTURE(Product, f32, Precision::kFloat32)->Apply(Sizes);
BENCHMARK_CAPTURE(Product, int16, Precision::kInt16)->Apply(Sizes);

// One decoder state over a window of 45 frames.
constexpr int kFrames = 45, kAttention = 128, kGates = 960;

void BM_WeighFrames(benchmark::State& state) {
  const std::vector<float> encoded = Values(kFrames * kAttention), query = Values(kAttention),
                           score = Values(kAttention);
  std::vector<float> weights(kFrames);
  for (auto _ : state) {
    WeighFrames({kFrames, kAttention, encoded.data(), query.data(), score.data(), weights.data()});
    benchmark::ClobberMemory();
  }
  PerSecond(state, "tanh/s", kFrames * kAttention);
}
BENCHMARK(BM_WeighFrames);

void BM_AddWeighted(benchmark::State& state) {
  const std::vector<float> values = Values(kFrames * kGates), weights = Values(kFrames);
  std::vector<float> sums(kGates);
  for (auto _ : state) {
    AddWeighted(kFrames, kGates, values.data(), weights.data(), sums.data());
    benchmark::ClobberMemory();
  }
  PerSecond(state, "FLOP/s", 2.0 * kFrames * kGates);
}
BENCHMARK(BM_AddWeighted);

void BM_LstmCells(benchmark::State& state) {
  constexpr int kRows = 16, kHidden = 240;
  const std::vector<float> gates = Values(kRows * 4 * kHidden);
  std::vector<float> hidden(kRows * kHidden), cell(kRows * kHidden), out(kRows * kHidden);
  std::vector<float*> outputs;
  for (int r = 0; r < kRows; ++r) outputs.push_back(out.data() + r * kHidden);
  for (auto _ : state) {
    LstmCells({kRows, kHidden, gates.data(), 4 * kHidden, nullptr, hidden.data(), cell.data(),
               kHidden, outputs.data()});
    benchmark::ClobberMemory();
  }
  PerSecond(state, "cells/s", kRows * kHidden);
}
BENCHMARK(BM_LstmCells);

void BM_SelfAttention(benchmark::State& state) {
  constexpr int kSize = 40, kWidth = 160;
  const std::vector<float> all = Values(kFrames * 3 * kWidth), distance = Values(2 * kFrames - 1);
  std::vector<float> out(kFrames * kWidth);
  std::vector<float> scratch(static_cast<std::size_t>(SelfAttentionScratch(kFrames, kSize)));
  for (auto _ : state) {
    AttendToSelf({kFrames, kSize, all.data(), all.data() + kWidth, all.data() + 2 * kWidth,
                  3 * kWidth, distance.data(), out.data(), kWidth, scratch.data()});
    benchmark::ClobberMemory();
  }
  PerSecond(state, "FLOP/s", 4.0 * kFrames * kFrames * kSize);
}
BENCHMARK(BM_SelfAttention);

void BM_Gelu(benchmark::State& state) {
  std::vector<float> values = Values(45 * 480);
  for (auto _ : state) {
    Gelu(static_cast<std::ptrdiff_t>(values.size()), values.data());
    benchmark::ClobberMemory();
  }
  PerSecond(state, "values/s", static_cast<double>(values.size()));
}
BENCHMARK(BM_Gelu);

void BM_LayerNorm(benchmark::State& state) {
  const std::vector<float> x = Values(160), scale = Values(160), shift = Values(160);
  std::vector<float> out(160);
  for (auto _ : state) {
    LayerNorm({160, x.data(), scale.data(), 1, shift.data(), out.data()});
    benchmark::ClobberMemory();
  }
  PerSecond(state, "values/s", 160);
}
BENCHMARK(BM_LayerNorm);

}  // namespace
}  // namespace duet::cpu_engine::kernels

#include "model/cpu_engine/kernels/recurrent.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/cpu_engine/kernels/every_target.h"

namespace duet::cpu_engine::kernels {
namespace {

std::size_t At(int row, int columns, int column) {
  return static_cast<std::size_t>(row * columns + column);
}

double Sigmoid(double x) { return 1 / (1 + std::exp(-x)); }

class LstmCellsTest : public EveryTarget {};
DUET_FOR_EVERY_TARGET(LstmCellsTest);

TEST_P(LstmCellsTest, EqualsTheDefinition) {
  constexpr int kRows = 3;
  for (const int hidden : {1, 7, 16, 40}) {
    const int gates = 4 * hidden, stride = hidden + 5;
    // Up to values at which the functions saturate.
    const std::vector<float> recurrent = Values(kRows * gates, 20),
                             input = Values(kRows * gates, 3);
    const std::vector<float> before = Values(kRows * stride, 2);
    std::vector<float> cell = before, state(before.size(), -99),
                       out(static_cast<std::size_t>(kRows * hidden));
    const float* inputs[kRows];
    float* outputs[kRows];
    for (int r = 0; r < kRows; ++r) {
      inputs[r] = input.data() + At(r, gates, 0);
      outputs[r] = out.data() + At(r, hidden, 0);
    }
    LstmCells({kRows, hidden, recurrent.data(), gates, inputs, state.data(), cell.data(), stride,
               outputs});
    for (int r = 0; r < kRows; ++r) {
      for (int u = 0; u < hidden; ++u) {
        const auto gate = [&](int g) {
          const std::size_t at = At(r, gates, g * hidden + u);
          return double{recurrent[at]} + input[at];
        };
        const double after =
            Sigmoid(gate(1)) * before[At(r, stride, u)] + Sigmoid(gate(0)) * std::tanh(gate(2));
        const double h = Sigmoid(gate(3)) * std::tanh(after);
        EXPECT_NEAR(cell[At(r, stride, u)], after, 1e-6) << hidden << " " << u;
        EXPECT_NEAR(state[At(r, stride, u)], h, 1e-6) << hidden << " " << u;
        EXPECT_EQ(out[At(r, hidden, u)], state[At(r, stride, u)]);
      }
      EXPECT_EQ(state[At(r, stride, hidden)], -99) << "wrote past a row";
    }
  }
}

TEST_P(LstmCellsTest, AcceptsEitherPartOfTheGatesMissing) {
  constexpr int kHidden = 9;
  const std::vector<float> gates = Values(4 * kHidden);
  const float* inputs[] = {gates.data()};
  std::vector<float> state(kHidden), from_input(kHidden), from_gates(kHidden);
  const auto run = [&](const float* recurrent, const float* const* input, std::vector<float>* out) {
    std::vector<float> cell(kHidden, 0.5f);
    float* outputs[] = {out->data()};
    LstmCells(
        {1, kHidden, recurrent, 4 * kHidden, input, state.data(), cell.data(), kHidden, outputs});
  };
  run(nullptr, inputs, &from_input);
  run(gates.data(), nullptr, &from_gates);
  EXPECT_EQ(from_input, from_gates);
  EXPECT_NE(from_input[0], 0);
}

class AdditiveAttentionTest : public EveryTarget {};
DUET_FOR_EVERY_TARGET(AdditiveAttentionTest);

TEST_P(AdditiveAttentionTest, EqualsTheDefinition) {
  for (const int frames : {1, 2, 16, 45}) {
    for (const int attention : {1, 19, 128}) {
      const int width = 3 * attention + 5;
      const std::vector<float> encoded = Values(frames * attention, 2),
                               values = Values(frames * width), query = Values(attention),
                               score = Values(attention, 3), before = Values(width);
      std::vector<float> sums = before, weights(static_cast<std::size_t>(frames));
      WeighFrames({frames, attention, encoded.data(), query.data(), score.data(), weights.data()});
      AddWeighted(frames, width, values.data(), weights.data(), sums.data());
      std::vector<double> expected;
      double all = 0;
      for (int j = 0; j < frames; ++j) {
        double energy = 0;
        for (int a = 0; a < attention; ++a) {
          energy += score[At(0, 0, a)] *
                    std::tanh(double{encoded[At(j, attention, a)]} + query[At(0, 0, a)]);
        }
        expected.push_back(std::exp(energy));
        all += expected.back();
      }
      for (int j = 0; j < frames; ++j) {
        EXPECT_NEAR(weights[At(0, 0, j)], expected[At(0, 0, j)] / all, 1e-5) << frames << " " << j;
      }
      for (int n = 0; n < width; ++n) {
        double sum = before[At(0, 0, n)];
        for (int j = 0; j < frames; ++j) {
          sum += expected[At(0, 0, j)] / all * values[At(j, width, n)];
        }
        EXPECT_NEAR(sums[At(0, 0, n)], sum, 2e-5) << frames << " " << n;
      }
    }
  }
}

}  // namespace
}  // namespace duet::cpu_engine::kernels

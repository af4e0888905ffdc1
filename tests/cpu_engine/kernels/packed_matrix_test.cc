#include "model/cpu_engine/kernels/packed_matrix.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/cpu_engine/kernels/every_target.h"

namespace duet::cpu_engine::kernels {
namespace {

class PackedMatrixTest : public EveryTarget {};
DUET_FOR_EVERY_TARGET(PackedMatrixTest);

struct Case {
  int rows, inputs, outputs;
};
// Every number of rows of a tile and more; odd numbers of inputs and more than are rounded at once;
// outputs below and above whole panels and vectors.
std::vector<Case> Cases() {
  std::vector<Case> cases;
  for (int rows = 1; rows <= 26; ++rows) cases.push_back({rows, 7, 45});
  for (const int outputs : {1, 15, 16, 17, 31, 32, 33, 64, 129, 200}) {
    cases.push_back({3, 5, outputs});
    cases.push_back({13, 40, outputs});
  }
  cases.push_back({5, 1, 33});
  cases.push_back({5, 1237, 40});
  cases.push_back({100, 64, 160});
  return cases;
}

TEST_P(PackedMatrixTest, EqualsTheDefinition) {
  for (const Case& c : Cases()) {
    const std::vector<float> weights = Values(c.outputs * c.inputs), bias = Values(c.outputs);
    // The stride of rows exceeds their length.
    const int x_stride = c.inputs + 3, y_stride = c.outputs + 2;
    const std::vector<float> x = Values(c.rows * x_stride);
    std::vector<float> y(static_cast<std::size_t>(c.rows * y_stride), -99);
    const PackedMatrix matrix(weights, bias, c.outputs, c.inputs, Precision::kFloat32);
    matrix.Multiply(c.rows, x.data(), x_stride, y.data(), y_stride);
    for (int r = 0; r < c.rows; ++r) {
      for (int n = 0; n < c.outputs; ++n) {
        double sum = bias[static_cast<std::size_t>(n)];
        for (int k = 0; k < c.inputs; ++k) {
          sum += double{x[static_cast<std::size_t>(r * x_stride + k)]} *
                 weights[static_cast<std::size_t>(n * c.inputs + k)];
        }
        ASSERT_NEAR(y[static_cast<std::size_t>(r * y_stride + n)], sum, 2e-6 * c.inputs + 1e-6)
            << c.rows << " rows, " << c.inputs << " -> " << c.outputs << " at " << r << ", " << n;
      }
      ASSERT_EQ(y[static_cast<std::size_t>(r * y_stride + c.outputs)], -99) << "wrote past a row";
    }
  }
}

TEST_P(PackedMatrixTest, ARowDoesNotDependOnTheOthers) {
  constexpr int kRows = 25, kInputs = 601, kOutputs = 77;
  for (const Precision precision : {Precision::kFloat32, Precision::kInt16}) {
    const PackedMatrix matrix(Values(kOutputs * kInputs), {}, kOutputs, kInputs, precision);
    const std::vector<float> x = Values(kRows * kInputs);
    std::vector<float> together(kRows * kOutputs), alone(kOutputs);
    matrix.Multiply(kRows, x.data(), together.data());
    for (int r = 0; r < kRows; ++r) {
      matrix.Multiply(1, x.data() + r * kInputs, alone.data());
      const std::vector<float> row(together.begin() + r * kOutputs,
                                   together.begin() + (r + 1) * kOutputs);
      EXPECT_EQ(alone, row) << r;
    }
  }
}

// The root of the sum of squares.
double Norm(const float* values, int count) {
  double squares = 0;
  for (int k = 0; k < count; ++k) squares += double{values[k]} * values[k];
  return std::sqrt(squares);
}

TEST_P(PackedMatrixTest, IntegersAreOffByLittleOfTheNorms) {
  for (const Case& c : Cases()) {
    const std::vector<float> weights = Values(c.outputs * c.inputs), bias = Values(c.outputs);
    const int x_stride = c.inputs + 3, y_stride = c.outputs + 2;
    std::vector<float> x = Values(c.rows * x_stride);
    x[0] = 1e4f;  // one value beside which the others are small
    std::vector<float> y(static_cast<std::size_t>(c.rows * y_stride), -99);
    const PackedMatrix matrix(weights, bias, c.outputs, c.inputs, Precision::kInt16);
    matrix.Multiply(c.rows, x.data(), x_stride, y.data(), y_stride);
    for (int r = 0; r < c.rows; ++r) {
      const float* const row = x.data() + r * x_stride;
      for (int n = 0; n < c.outputs; ++n) {
        const float* const column = weights.data() + n * c.inputs;
        double sum = bias[static_cast<std::size_t>(n)];
        for (int k = 0; k < c.inputs; ++k) sum += double{row[k]} * column[k];
        const double error = 6e-5 * Norm(row, c.inputs) * Norm(column, c.inputs) + 1e-6;
        ASSERT_NEAR(y[static_cast<std::size_t>(r * y_stride + n)], sum, error)
            << c.rows << " rows, " << c.inputs << " -> " << c.outputs << " at " << r << ", " << n;
      }
      ASSERT_EQ(y[static_cast<std::size_t>(r * y_stride + c.outputs)], -99) << "wrote past a row";
    }
  }
}

// Rows that reach the bound of the sums: in one value, and in all alike.
TEST_P(PackedMatrixTest, SumsOfIntegersNeverOverflow) {
  for (const int inputs : {1, 2, 3, 300, 512}) {
    for (const float sign : {-1.0f, 1.0f}) {
      const std::vector<float> weights(static_cast<std::size_t>(inputs), 3.0f);
      const std::vector<float> x(static_cast<std::size_t>(inputs), sign * 7.0f);
      float y = 0;
      PackedMatrix(weights, {}, 1, inputs, Precision::kInt16).Multiply(1, x.data(), &y);
      EXPECT_NEAR(y / (sign * 21.0f * static_cast<float>(inputs)), 1, 1e-3) << inputs;
    }
  }
}

TEST_P(PackedMatrixTest, IntegersKeepZerosAndPassOnWhatIsNotFinite) {
  const PackedMatrix matrix({1, 2, 0, 0}, {5, 6}, 2, 2, Precision::kInt16);
  for (const auto& [value, finite] : {std::pair(0.0f, true),
                                      {1e-40f, true},
                                      {1e30f, false},
                                      {std::nanf(""), false},
                                      {HUGE_VALF, false}}) {
    const float x[] = {value, 0};
    float y[2];
    matrix.Multiply(1, x, y);
    EXPECT_EQ(std::isfinite(y[0]), finite) << value;
    if (!finite) continue;
    EXPECT_EQ(y[0], 5) << value;
    EXPECT_EQ(y[1], 6) << value;
  }
}

TEST(PackPanelsTest, PadsTheLastPanelWithZeros) {
  constexpr int kOutputs = 34, kInputs = 2;
  std::vector<float> by_output, by_input(kOutputs * kInputs);
  for (int n = 0; n < kOutputs; ++n) {
    for (int k = 0; k < kInputs; ++k) {
      by_output.push_back(static_cast<float>(100 * k + n + 1));
      by_input[static_cast<std::size_t>(k * kOutputs + n)] = by_output.back();
    }
  }
  std::vector<float> panels(2 * kInputs * kPanel, -99), same = panels;
  PackPanels(by_output.data(), kInputs, 1, kOutputs, kInputs, panels.data());
  PackPanels(by_input.data(), 1, kOutputs, kOutputs, kInputs, same.data());
  EXPECT_EQ(panels, same);
  EXPECT_EQ(panels[0], 1);
  EXPECT_EQ(panels[kPanel], 101);               // the second input
  EXPECT_EQ(panels[kInputs * kPanel + 1], 34);  // the last output
  EXPECT_EQ(panels[kInputs * kPanel + 2], 0);   // after it
  EXPECT_EQ(panels[(kInputs + 1) * kPanel + 31], 0);
}

}  // namespace
}  // namespace duet::cpu_engine::kernels

// Products in tiles, on any processor with AVX-512 BF16. Instructions that the processor does not
// have are emulated.
#include "model/cpu_engine/kernels/gemm_bf16_amx.h"

#include <gtest/gtest.h>

#include <vector>

#include "model/base/random.h"
#include "model/cpu_engine/kernels/gemm_bf16_portable.h"
#include "model/cpu_engine/kernels/packed_matrix.h"
#include "tests/cpu_engine/kernels/amx_test_fixture.h"

namespace duet::cpu_engine::kernels {
namespace {

std::vector<float> Values(int count, uint64_t seed) {
  base::Random random(seed);
  std::vector<float> values;
  for (int i = 0; i < count; ++i) values.push_back(static_cast<float>(random.Uniform(-1, 1)));
  return values;
}

// A product's operands. Panels end where their memory ends, so that AddressSanitizer detects a read
// past them.
struct Operands {
  Operands(int row_count, int input_count, int output_count)
      : rows(row_count),
        inputs(input_count),
        outputs(output_count),
        x_stride(inputs + 3),
        y_stride(outputs + 2),
        x(Values(rows * x_stride, 1)),
        bias(Values(PanelCount(outputs) * kPanel, 2)),
        before(Values(rows * y_stride, 3)),
        panels(static_cast<std::size_t>(PanelCount(outputs) * Bf16Pairs(inputs) * kPanel * 2)) {
    const std::vector<float> weights = Values(inputs * outputs, 4);
    PackRowsBf16Portable({weights.data(), outputs, inputs, outputs}, panels.data());
  }

  Rows x_rows() const { return {x.data(), x_stride, rows, inputs}; }
  Output y(std::vector<float>& values) const { return {values.data(), y_stride, outputs}; }

  int rows, inputs, outputs;
  std::ptrdiff_t x_stride, y_stride;
  std::vector<float> x, bias, before;
  std::vector<uint16_t> panels;
};

class GemmBf16AmxTest : public AmxTest {
 protected:
  // Compares both products from the same initial values, and checks that nothing is written past a
  // row.
  void ExpectSame(const Operands& with, const float* bias, bool adds) {
    std::vector<float> y = with.before, wanted = with.before;
    GemmBf16Amx(with.x_rows(), with.panels.data(), bias, adds, with.y(y));
    GemmBf16Portable(with.x_rows(), with.panels.data(), bias, adds, with.y(wanted));
    for (std::size_t i = 0; i < y.size(); ++i) {
      const bool inside = static_cast<int>(i) % static_cast<int>(with.y_stride) < with.outputs;
      ASSERT_NEAR(y[i], wanted[i], inside ? 1e-6 * with.inputs + 1e-6 : 0)
          << with.rows << " rows, " << with.inputs << " -> " << with.outputs << " at " << i;
    }
  }
};

// Rows below and above one and two tiles; inputs of whole steps, of a part of one, and of more than
// are rounded at once; outputs below and above whole tiles and panels.
TEST_F(GemmBf16AmxTest, EqualsThePortableProduct) {
  for (const int rows : {1, 15, 16, 17, 31, 32, 33, 49, 65}) {
    for (const int inputs : {1, 2, 7, 31, 32, 33, 64, 90, 257, 300}) {
      const Operands with(rows, inputs, 45);
      ExpectSame(with, with.bias.data(), false);
    }
  }
  for (const int outputs : {1, 15, 16, 17, 31, 32, 33, 64, 100}) {
    const Operands with(18, 70, outputs);
    ExpectSame(with, with.bias.data(), false);
  }
  EXPECT_TRUE(UsedTiles());
  EXPECT_TRUE(ReleasedTiles());
}

TEST_F(GemmBf16AmxTest, StartsFromZeroTheBiasOrEarlierSums) {
  for (const int inputs : {9, 64, 301}) {
    const Operands with(19, inputs, 50);
    ExpectSame(with, nullptr, false);
    ExpectSame(with, with.bias.data(), false);
    ExpectSame(with, nullptr, true);
  }
}

TEST_F(GemmBf16AmxTest, ARowDoesNotDependOnTheOthers) {
  const Operands with(37, 601, 77);
  std::vector<float> together = with.before, alone = with.before;
  GemmBf16Amx(with.x_rows(), with.panels.data(), nullptr, false, with.y(together));
  for (int r = 0; r < with.rows; ++r) {
    GemmBf16Amx({with.x.data() + r * with.x_stride, with.x_stride, 1, with.inputs},
                with.panels.data(), nullptr, false,
                {alone.data() + r * with.y_stride, with.y_stride, with.outputs});
  }
  EXPECT_EQ(alone, together);
}

TEST_F(GemmBf16AmxTest, AcceptsNoRows) {
  const Operands with(0, 8, 8);
  std::vector<float> y;
  GemmBf16Amx(with.x_rows(), with.panels.data(), nullptr, false, with.y(y));
}

// A layer that uses tiles has a result bit-identical to the product.
TEST_F(GemmBf16AmxTest, LayersUseIt) {
  constexpr int kRows = 5, kInputs = 40, kOutputs = 70;
  const std::vector<float> weights = Values(kInputs * kOutputs, 5), x = Values(kRows * kInputs, 6);
  const PackedMatrix matrix(weights, {}, kOutputs, kInputs, Precision::kBfloat16);
  std::vector<float> in_tiles(kRows * kOutputs), otherwise = in_tiles;
  matrix.Multiply(kRows, x.data(), in_tiles.data());
  EXPECT_TRUE(UsedTiles());
  ChooseBf16Product(Bf16Product::kAvx512);
  matrix.Multiply(kRows, x.data(), otherwise.data());
  EXPECT_NE(in_tiles, otherwise);  // sums are rounded in another order
  for (std::size_t i = 0; i < otherwise.size(); ++i) EXPECT_NEAR(in_tiles[i], otherwise[i], 1e-5);
}

}  // namespace
}  // namespace duet::cpu_engine::kernels

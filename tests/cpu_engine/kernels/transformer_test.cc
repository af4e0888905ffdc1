#include "model/cpu_engine/kernels/transformer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "model/base/random.h"
#include "tests/cpu_engine/kernels/every_target.h"

namespace duet::cpu_engine::kernels {
namespace {

class RowwiseTest : public EveryTarget {};
DUET_FOR_EVERY_TARGET(RowwiseTest);

TEST_P(RowwiseTest, GeluAndSiluEqualTheirDefinitions) {
  for (const int count : {1, 15, 33, 200}) {
    const std::vector<float> x = Values(count, 6);
    std::vector<float> gelu = x, silu = x;
    Gelu(count, gelu.data());
    Silu(count, silu.data());
    for (std::size_t i = 0; i < x.size(); ++i) {
      EXPECT_NEAR(gelu[i], 0.5 * x[i] * (1 + std::erf(x[i] / std::sqrt(2.0))), 2e-6) << x[i];
      EXPECT_NEAR(silu[i], x[i] / (1 + std::exp(-double{x[i]})), 2e-6) << x[i];
    }
  }
}

TEST_P(RowwiseTest, GeluAndSiluReachTheirLimits) {
  std::vector<float> gelu = {-40, 40, -1e6f, 1e6f}, silu = gelu;
  Gelu(4, gelu.data());
  Silu(4, silu.data());
  for (const std::vector<float>& values : {gelu, silu}) {
    EXPECT_NEAR(values[0], 0, 1e-6);
    EXPECT_FLOAT_EQ(values[1], 40);
    EXPECT_NEAR(values[2], 0, 1e-6);
    EXPECT_FLOAT_EQ(values[3], 1e6f);
  }
}

TEST_P(RowwiseTest, LayerNormEqualsItsDefinition) {
  for (const int width : {2, 16, 19, 160}) {
    const std::vector<float> x = Values(width, 5), scale = Values(width), shift = Values(width);
    std::vector<float> out(x.size());
    LayerNorm({width, x.data(), scale.data(), 1, shift.data(), out.data()});
    double mean = 0, variance = 0;
    for (const float value : x) mean += value / width;
    for (const float value : x) variance += (value - mean) * (value - mean) / width;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double normal = (x[i] - mean) / std::sqrt(variance + 1e-5);
      EXPECT_NEAR(out[i], normal * (scale[i] + 1) + shift[i], 1e-5) << width << " " << i;
    }
  }
}

class StandardNormalsTest : public EveryTarget {};
DUET_FOR_EVERY_TARGET(StandardNormalsTest);

TEST_P(StandardNormalsTest, EqualThoseOfRandom) {
  for (const int count : {1, 7, 8, 1001}) {
    base::Random uniform(5, 0), normal(5, 0);
    std::vector<double> pairs;
    for (int i = 0; i < 2 * count; ++i) pairs.push_back(uniform.OpenUniform());
    std::vector<float> out(pairs.size() / 2);
    StandardNormals(count, pairs.data(), out.data());
    for (const float value : out) EXPECT_NEAR(value, normal.StandardNormal(), 1e-6);
  }
}

TEST_P(StandardNormalsTest, AreFiniteAtTheEndsOfTheUniformRange) {
  const double step = 0x1p-54;
  const std::vector<double> pairs = {step, 1 - 2 * step, 1 - 2 * step, step};
  float out[2];
  StandardNormals(2, pairs.data(), out);
  EXPECT_NEAR(out[0], std::sqrt(-2 * std::log(step)), 1e-5);
  EXPECT_NEAR(out[1], 0, 1e-6);
}

class SelfAttentionTest : public EveryTarget {};
DUET_FOR_EVERY_TARGET(SelfAttentionTest);

struct Attention {
  int frames, size;
  float spread;  // of the bias: with a large one, a few keys have all the weight
};

TEST_P(SelfAttentionTest, EqualsItsDefinition) {
  for (const int frames : {1, 5, 33, 45, 100}) {
    for (const Attention& a :
         {Attention{frames, 3, 1}, Attention{frames, 40, 1}, Attention{frames, 70, 60}}) {
      const int size = a.size;
      const int stride = 3 * size + 2, out_stride = size + 1;
      const std::vector<float> all = Values(frames * stride, 2),
                               distance = Values(2 * frames - 1, a.spread);
      std::vector<float> out(static_cast<std::size_t>(frames * out_stride), -99);
      std::vector<float> scratch(static_cast<std::size_t>(SelfAttentionScratch(frames, size)));
      AttendToSelf({frames, size, all.data(), all.data() + size, all.data() + 2 * size, stride,
                    distance.data(), out.data(), out_stride, scratch.data()});
      const auto value = [&](int which, int t, int i) {
        return double{all[static_cast<std::size_t>(t * stride + which * size + i)]};
      };
      for (int t = 0; t < frames; ++t) {
        std::vector<double> weights;
        double sum = 0;
        for (int j = 0; j < frames; ++j) {
          double score = distance[static_cast<std::size_t>(j - t + frames - 1)];
          for (int i = 0; i < size; ++i) score += value(0, t, i) * value(1, j, i) / std::sqrt(size);
          weights.push_back(std::exp(score));
          sum += weights.back();
        }
        for (int i = 0; i < size; ++i) {
          double expected = 0;
          for (int j = 0; j < frames; ++j) {
            expected += weights[static_cast<std::size_t>(j)] / sum * value(2, j, i);
          }
          EXPECT_NEAR(out[static_cast<std::size_t>(t * out_stride + i)], expected, a.spread * 1e-5)
              << frames << " " << size << " " << t;
        }
        EXPECT_EQ(out[static_cast<std::size_t>(t * out_stride + size)], -99) << "past a row";
      }
    }
  }
}

}  // namespace
}  // namespace duet::cpu_engine::kernels

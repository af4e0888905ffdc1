#include "model/cpu_engine/weights.h"

#include <gtest/gtest.h>

namespace duet::cpu_engine {
namespace {

std::vector<float> Applied(const Layer& layer, const std::vector<float>& x) {
  std::vector<float> y(static_cast<std::size_t>(layer.outputs));
  layer.Pack(kernels::Precision::kFloat32).Multiply(1, x.data(), y.data());
  return y;
}

const Layer kFirst = {{1, 2, 3, 4, 5, 6}, {0.5f, -1, 2}, 3, 2};
const Layer kSecond = {{1, 0, -1, 2, 1, 0.5f}, {10, 20}, 2, 3};

TEST(WeightsTest, ChainedLayerEqualsBothLayersInSequence) {
  const std::vector<float> x = {3, -2};
  EXPECT_EQ(Applied(Chained(kFirst, kSecond), x), Applied(kSecond, Applied(kFirst, x)));
  // If the second layer has no bias, the result has that of the first.
  const Layer no_bias = {kSecond.weight, {}, 2, 3};
  EXPECT_EQ(Applied(Chained(kFirst, no_bias), x), Applied(no_bias, Applied(kFirst, x)));
}

TEST(WeightsTest, StackedLayerHasTheOutputsOfBoth) {
  const Layer other = {{7, 8}, {9}, 1, 2};
  const std::vector<float> x = {3, -2};
  std::vector<float> expected = Applied(kFirst, x);
  expected.push_back(Applied(other, x).front());
  EXPECT_EQ(Applied(Stacked(kFirst, other), x), expected);
}

TEST(WeightsTest, LayersAreFoundByName) {
  const checkpoint::Checkpoint checkpoint{
      {}, {{"a.weight", {3, 2}, kFirst.weight}, {"a.bias", {3}, kFirst.bias}}};
  const Weights weights(checkpoint);
  const Layer layer = weights.FindLayer("a");
  EXPECT_EQ(layer.outputs, 3);
  EXPECT_EQ(layer.inputs, 2);
  EXPECT_EQ(layer.weight, kFirst.weight);
  EXPECT_EQ(layer.bias, kFirst.bias);
  EXPECT_TRUE(weights.FindLayer("a.weight", "").bias.empty());
  EXPECT_TRUE(weights.Has("a.bias"));
  EXPECT_FALSE(weights.Has("b.bias"));
}

}  // namespace
}  // namespace duet::cpu_engine

#include "model/network/flow_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "model/engine/frame_noise.h"
#include "tests/network/flow_test_support.h"

namespace duet::network {
namespace {

constexpr int64_t kWindows = 400, kFrames = 20, kWidth = 3;

NoiseNumbers Numbers() {
  torch::manual_seed(2);
  return {torch::randn({kWindows, kFrames, kWidth}), torch::randn({kWindows, kFrames, kWidth})};
}

torch::Tensor Roots() { return torch::eye(kWidth).expand({2, kWidth, kWidth}); }

torch::Tensor Told(int64_t count) { return torch::full({kWindows}, count, torch::kInt64); }

// [T] over windows and coordinates.
torch::Tensor Deviation(const torch::Tensor& noise) {
  return noise.square().mean(2).mean(0).sqrt();
}

TEST(SourceNoiseTest, HasTheTrainingOffsetsDeviationAndIsSmooth) {
  const checkpoint::FlowArchitecture::Noise options = test::SmallFlow().noise;
  const torch::Tensor noise = SourceNoise(options, 2 * Roots(), Told(0), Numbers());
  EXPECT_NEAR(Deviation(noise).mean().item<float>(), 2, 0.1);
  const torch::Tensor moved = noise.slice(1, 1) - noise.slice(1, 0, -1);
  EXPECT_LT(Deviation(moved).mean().item<float>(), 0.5);
  // The constant part correlates frames beyond the kernel's length.
  const torch::Tensor ends = (noise.select(1, 0) * noise.select(1, kFrames - 1)).mean();
  EXPECT_NEAR(ends.item<float>(), 4 * options.constant_share, 0.5);
}

TEST(SourceNoiseTest, FramesDoNotDependOnLaterFrames) {
  const NoiseNumbers all = Numbers();
  const NoiseNumbers first = {all.smooth.narrow(1, 0, 7), all.white.narrow(1, 0, 7)};
  const checkpoint::FlowArchitecture::Noise options = test::SmallFlow().noise;
  for (const int64_t told : {0, 2}) {
    EXPECT_TRUE(torch::allclose(SourceNoise(options, Roots(), Told(told), all).narrow(1, 0, 7),
                                SourceNoise(options, Roots(), Told(told), first), 1e-4, 1e-5));
  }
}

TEST(DrawNoiseTest, AFrameOfAnEndlessMotionHasTheSameNoiseInEveryWindow) {
  const checkpoint::Manifest manifest = SmallFlowManifest();
  std::vector<engine::NetworkInput> inputs = {FlowWindow(manifest, 9), FlowWindow(manifest, 9)};
  for (engine::NetworkInput& input : inputs) input.sampling.seed = 11;
  inputs[0].sampling.first_frame = 1000;
  inputs[1].sampling.first_frame = 1003;
  const NoiseNumbers numbers = DrawNoise(inputs, 4);
  EXPECT_TRUE(
      torch::allclose(numbers.smooth[0].narrow(0, 3, 6), numbers.smooth[1].narrow(0, 0, 6)));
  EXPECT_TRUE(torch::equal(numbers.white[0].narrow(0, 3, 6), numbers.white[1].narrow(0, 0, 6)));
  EXPECT_TRUE(torch::equal(numbers.constant[0], numbers.constant[1]));
  EXPECT_FALSE(torch::equal(numbers.white[0], numbers.white[1]));
}

TEST(SourceNoiseTest, EndlessNoiseHasTheCovarianceThatTheLastKnownFrameLeaves) {
  checkpoint::FlowArchitecture::Noise options = test::SmallFlow().noise;
  options.white = 0;
  const checkpoint::Manifest manifest = SmallFlowManifest();
  std::vector<engine::NetworkInput> inputs(400, FlowWindow(manifest, 9));
  for (std::size_t n = 0; n < inputs.size(); ++n) {
    inputs[n].sampling.seed = n;
    inputs[n].sampling.first_frame = 5;
  }
  const NoiseNumbers drawn = DrawNoise(inputs, options.frame_length);
  const int64_t width = drawn.white.size(2);
  const torch::Tensor roots = torch::eye(width).expand({2, width, width});
  torch::manual_seed(1);
  const NoiseNumbers random = RandomNumbers(drawn.white, drawn.endless, options.frame_length);
  const auto smooth = [&](int frames) {
    const double distance = frames / options.frame_length;
    return std::exp(-0.5 * distance * distance);
  };
  for (const auto& [told, numbers] :
       {std::pair<int64_t, NoiseNumbers>(0, drawn), {4, drawn}, {0, random}, {4, random}}) {
    const torch::Tensor noise =
        SourceNoise(options, roots, torch::full({400}, told, torch::kInt64), numbers);
    // Between frames 8 and 6; frame 3 is the last known one.
    const double wanted = told == 0
                              ? options.constant_share + (1 - options.constant_share) * smooth(2)
                              : smooth(2) - smooth(5) * smooth(3);
    EXPECT_NEAR((noise.select(1, 8) * noise.select(1, 6)).mean().item<double>(), wanted, 0.05)
        << told;
  }
}

}  // namespace
}  // namespace duet::network

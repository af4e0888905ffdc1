#include "model/network/flow_sampler.h"

#include <gtest/gtest.h>

#include "model/network/batch.h"
#include "tests/network/flow_test_support.h"
#include "tests/support/architectures.h"

namespace duet::network {
namespace {

constexpr double kRounding = 1e-5;

class FlowSamplerTest : public ::testing::Test {
 protected:
  FlowSamplerTest() { torch::set_num_threads(1); }

  torch::Tensor Answer(const std::vector<engine::NetworkInput>& inputs) {
    torch::NoGradGuard no_grad;
    return AnswerWindows(generator_, manifest_, inputs);
  }
  torch::Tensor Answer(const engine::NetworkInput& input) { return Answer(std::vector{input})[0]; }

  // The maximum difference, metres.
  static double Apart(const torch::Tensor& a, const torch::Tensor& b) {
    return (a - b).abs().max().item<double>();
  }

  checkpoint::Manifest manifest_ = SmallFlowManifest();
  FlowGenerator generator_ = RandomFlowGenerator(manifest_);
};

TEST_F(FlowSamplerTest, WindowDoesNotDependOnItsBatch) {
  engine::NetworkInput mixed = FlowWindow(manifest_, 5, 1, 0.5f);
  mixed.labels[0] = 0.25f;
  mixed.sampling.seed = 7;
  engine::NetworkInput told = FlowWindow(manifest_, 9, 2);
  told.settled = SettledFrames(manifest_, 3);
  told.start = StartAt(told.settled, manifest_.model.skeleton.root);
  const std::vector<engine::NetworkInput> all = {FlowWindow(manifest_, 12), mixed, told};
  const torch::Tensor together = Answer(all);
  for (size_t i = 0; i < all.size(); ++i) {
    const torch::Tensor alone = Answer(all[i]);
    EXPECT_LT(Apart(together[static_cast<int64_t>(i)].narrow(0, 0, alone.size(0)), alone),
              kRounding)
        << i;
  }
}

TEST_F(FlowSamplerTest, SameSeedSameAnswerOtherSeedOtherAnswer) {
  engine::NetworkInput input = FlowWindow(manifest_, 10);
  input.sampling.seed = 3;
  const torch::Tensor answer = Answer(input);
  torch::rand({5});  // LibTorch's own random numbers have no effect
  EXPECT_TRUE(torch::equal(Answer(input), answer));
  input.sampling.seed = 4;
  EXPECT_GT(Apart(Answer(input), answer), 0.01);
}

TEST_F(FlowSamplerTest, VarietyScalesTheDifferencesBetweenSeeds) {
  const auto spread = [&](float variety) {
    engine::NetworkInput one = FlowWindow(manifest_, 10), other = one;
    one.sampling = {1, variety};
    other.sampling = {2, variety};
    return Apart(Answer(one), Answer(other));
  };
  EXPECT_EQ(spread(0), 0);
  EXPECT_GT(spread(1), spread(0.1f));
}

TEST_F(FlowSamplerTest, KnownFramesAreExactAndTheNextOnesContinueThem) {
  for (const int known : {1, 2, 5}) {
    engine::NetworkInput input = FlowWindow(manifest_, 12);
    input.settled = SettledFrames(manifest_, known);
    input.start = StartAt(input.settled, manifest_.model.skeleton.root);
    if (known == 1) input.settled = {};
    const torch::Tensor answer = Answer(input);
    const motion::Poses wanted = SettledFrames(manifest_, known);
    EXPECT_LT(Apart(answer.narrow(0, 0, known), PadPoses({&wanted}, known)[0]), kRounding);
    const checkpoint::FlowArchitecture& flow = test::FlowOf(manifest_);
    test::FlowOf(manifest_).fade_frames = 0;
    const torch::Tensor unfaded = Answer(input);
    test::FlowOf(manifest_).fade_frames = 5;
    EXPECT_LT(Apart(answer[known], answer[known - 1]), Apart(unfaded[known], unfaded[known - 1]));
    EXPECT_TRUE(torch::equal(answer.slice(0, known + flow.fade_frames),
                             unfaded.slice(0, known + flow.fade_frames)));
  }
}

TEST_F(FlowSamplerTest, BaseIsTheWeightedMeanPoseOfTheClasses) {
  const torch::Tensor& poses = generator_->base_poses();
  const torch::Tensor mean = poses.mean(0);
  const auto base = [&](const engine::NetworkInput& window) {
    return MakeFlowInput(manifest_, poses, {&window, 1}).base[0];
  };
  EXPECT_LT(Apart(base(FlowWindow(manifest_, 6, 1)), poses[1]), kRounding);
  EXPECT_LT(Apart(base(FlowWindow(manifest_, 6, 1, 0)), mean), kRounding);
  EXPECT_LT(Apart(base(FlowWindow(manifest_, 6, 2, -0.5f)), mean - 0.5 * (poses[2] - mean)),
            kRounding);
}

TEST_F(FlowSamplerTest, LabelsMayDifferFromFrameToFrame) {
  engine::NetworkInput changing = FlowWindow(manifest_, 8, 0);
  const size_t classes = manifest_.model.classes.size();
  for (size_t t = 4; t < 8; ++t) {
    changing.labels[t * classes] = 0;
    changing.labels[t * classes + 1] = 1;
  }
  const FlowInput input = MakeFlowInput(manifest_, generator_->base_poses(), {&changing, 1});
  const GuidanceTerms terms = MakeGuidanceTerms(input.labels, input.lengths, 1.5);
  ASSERT_EQ(terms.windows.size(0), 3);  // of no class, of the first, of the second
  const torch::Tensor factors = terms.factors.squeeze(2);
  EXPECT_TRUE(torch::allclose(factors[0], torch::full({8}, -0.5)));
  EXPECT_TRUE(torch::equal(factors[1] > 0, torch::arange(8) < 4));
  EXPECT_TRUE(torch::equal(factors[2] > 0, torch::arange(8) >= 4));
  EXPECT_EQ(factors.max().item<float>(), 1.5f);
}

TEST(GuidanceTermsTest, GuidanceDoesNotScaleNegativeWeights) {
  const GuidanceTerms terms =
      MakeGuidanceTerms(torch::full({1, 2, 1}, -0.5), torch::tensor({2}), 3);
  EXPECT_EQ(terms.factors[0][0].item<float>(), 1.5f);
  EXPECT_EQ(terms.factors[1][0].item<float>(), -0.5f);
}

}  // namespace
}  // namespace duet::network

#include "model/network/generator.h"

#include <gtest/gtest.h>

#include <cmath>

#include "model/network/parameters.h"
#include "tests/network/test_manifest.h"
#include "tests/support/architectures.h"

namespace duet::network {
namespace {

constexpr int64_t kFrames = 9, kBatch = 4, kJoints = 15, kClasses = 3;

GeneratorInput MakeInput(const checkpoint::Manifest& manifest) {
  torch::manual_seed(3);
  GeneratorInput input;
  input.leader = torch::randn({kBatch, kFrames, 3 * kJoints});
  input.labels = torch::randn({kBatch, kFrames, kClasses});
  input.start = torch::randn({kBatch, checkpoint::StartFeatureCount(manifest.model.skeleton)});
  input.lengths = torch::tensor({9, 5, 2, 7}, torch::kInt64);
  return input;
}

Generator MakeGenerator(const checkpoint::Manifest& manifest) {
  torch::manual_seed(4);
  Generator generator(manifest);
  generator->eval();
  return generator;
}

// One clip of a batch, without its padding.
GeneratorInput Single(const GeneratorInput& batch, int64_t clip) {
  const int64_t length = batch.lengths[clip].item<int64_t>();
  return {batch.leader[clip].narrow(0, 0, length).unsqueeze(0),
          batch.labels[clip].narrow(0, 0, length).unsqueeze(0), batch.start[clip].unsqueeze(0),
          batch.lengths[clip].unsqueeze(0)};
}

TEST(GeneratorTest, BatchEqualsSingle) {
  const checkpoint::Manifest manifest = SmallManifest();
  Generator generator = MakeGenerator(manifest);
  const GeneratorInput input = MakeInput(manifest);
  torch::NoGradGuard no_grad;
  const torch::Tensor together = generator->forward(input);
  for (int64_t clip = 0; clip < kBatch; ++clip) {
    const int64_t length = input.lengths[clip].item<int64_t>();
    const torch::Tensor alone = generator->forward(Single(input, clip))[0];
    EXPECT_LT((together[clip].narrow(0, 0, length) - alone).abs().max().item<float>(), 1e-5);
  }
}

TEST(GeneratorTest, PaddingHasNoInfluence) {
  const checkpoint::Manifest manifest = SmallManifest();
  Generator generator = MakeGenerator(manifest);
  GeneratorInput input = MakeInput(manifest);
  torch::NoGradGuard no_grad;
  const torch::Tensor before = generator->forward(input)[1].narrow(0, 0, 5).clone();
  input.leader[1].narrow(0, 5, kFrames - 5).fill_(1e3);
  input.labels[1].narrow(0, 5, kFrames - 5).fill_(-1e3);
  EXPECT_TRUE(torch::equal(generator->forward(input)[1].narrow(0, 0, 5), before));
}

TEST(GeneratorTest, EveryParameterAndInputHasAGradient) {
  const checkpoint::Manifest manifest = SmallManifest();
  Generator generator = MakeGenerator(manifest);
  GeneratorInput input = MakeInput(manifest);
  input.labels.requires_grad_();
  input.start.requires_grad_();
  generator->forward(input).square().mean().backward();
  for (const auto& named : generator->named_parameters()) {
    const torch::Tensor gradient = named.value().grad();
    ASSERT_TRUE(gradient.defined()) << named.key();
    EXPECT_GT(gradient.abs().max().item<float>(), 0) << named.key();
  }
  EXPECT_GT(input.labels.grad().abs().max().item<float>(), 0);
  EXPECT_GT(input.start.grad().abs().max().item<float>(), 0);
}

TEST(GeneratorTest, GradientEqualsFiniteDifference) {
  const checkpoint::Manifest manifest = SmallManifest();
  Generator generator = MakeGenerator(manifest);
  const GeneratorInput input = MakeInput(manifest);
  const torch::Tensor toward = torch::randn({kBatch, kFrames, 3 * kJoints});
  const auto loss = [&] { return (generator->forward(input) * toward).sum(torch::kFloat64); };
  loss().backward();
  torch::NoGradGuard no_grad;
  for (torch::Tensor parameter : generator->parameters()) {
    torch::Tensor value = parameter.flatten()[0];
    const double wanted = parameter.grad().flatten()[0].item<double>(), step = 1e-2;
    value.add_(step);
    const double above = loss().item<double>();
    value.sub_(2 * step);
    const double below = loss().item<double>();
    value.add_(step);
    EXPECT_NEAR((above - below) / (2 * step), wanted, 1e-2 * std::max(1.0, std::abs(wanted)));
  }
}

TEST(GeneratorTest, StoredParametersLoadBack) {
  const checkpoint::Manifest manifest = SmallManifest();
  Generator generator = MakeGenerator(manifest);
  const checkpoint::Checkpoint checkpoint{manifest, StoreParameters(manifest, generator)};
  Generator other(manifest);
  ASSERT_TRUE(LoadParameters(checkpoint, other).ok());
  torch::NoGradGuard no_grad;
  other->eval();
  const GeneratorInput input = MakeInput(manifest);
  EXPECT_TRUE(torch::equal(other->forward(input), generator->forward(input)));
}

TEST(GeneratorTest, ForeignParametersAreRejectedByName) {
  const checkpoint::Manifest manifest = SmallManifest();
  Generator generator = MakeGenerator(manifest);
  checkpoint::Checkpoint checkpoint{manifest, StoreParameters(manifest, generator)};
  checkpoint.tensors.pop_back();
  EXPECT_NE(LoadParameters(checkpoint, generator).message().find("\"output.bias\" is missing"),
            std::string::npos);
  checkpoint.tensors[0].shape.push_back(1);
  EXPECT_NE(LoadParameters(checkpoint, generator).message().find(checkpoint.tensors[0].name),
            std::string::npos);
}

TEST(GeneratorTest, BasePoseIsTheKnownPartOfTheStart) {
  checkpoint::Manifest manifest = SmallManifest();
  test::PaperOf(manifest).base_pose = true;
  Generator generator = MakeGenerator(manifest);
  torch::NoGradGuard no_grad;
  generator->tensors().at("output.weight").zero_();
  const torch::Tensor means = torch::randn({kClasses, 3 * kJoints});
  generator->SetBasePoses(means);
  GeneratorInput input = MakeInput(manifest);
  input.labels.zero_();
  input.labels.select(2, 1).fill_(1);
  input.start.zero_();
  const int64_t width = input.start.size(1);
  const torch::Tensor start = torch::randn({width - 2});
  for (int64_t clip : {1, 2}) input.start[clip].narrow(0, 0, width - 2).copy_(start);
  input.start[1][width - 2] = 1;  // only the root
  input.start[2][width - 2] = 1;  // root and pose
  input.start[2][width - 1] = 1;
  const torch::Tensor out = generator->forward(input).reshape({kBatch, kFrames, kJoints, 3});
  const torch::Tensor mean = means[1].reshape({kJoints, 3}), root = start.narrow(0, 0, 3);
  const int64_t torso = manifest.model.skeleton.root;
  EXPECT_TRUE(torch::allclose(out[0][3], mean, 1e-5, 1e-5));
  EXPECT_TRUE(torch::allclose(out[1][3], mean - mean[torso] + root, 1e-5, 1e-5));
  EXPECT_TRUE(
      torch::allclose(out[2][3], root + start.narrow(0, 3, 45).reshape({kJoints, 3}), 1e-5, 1e-5));
}

TEST(GeneratorTest, UnlabelledVariantDoesNotReadTheLabel) {
  checkpoint::Manifest manifest = SmallManifest();
  test::PaperOf(manifest).variant = checkpoint::GeneratorVariant::kUnlabelled;
  test::PaperOf(manifest).base_pose = true;
  Generator generator = MakeGenerator(manifest);
  generator->SetBasePoses(torch::randn({kClasses, 3 * kJoints}));
  GeneratorInput input = MakeInput(manifest);
  const torch::Tensor before = generator->forward(input);
  input.labels = input.labels + 1;
  EXPECT_TRUE(torch::equal(generator->forward(input), before));
  input.leader = input.leader + 0.1;
  EXPECT_FALSE(torch::equal(generator->forward(input), before));
}

}  // namespace
}  // namespace duet::network

#include "model/network/losses.h"

#include <gtest/gtest.h>

#include <cmath>

#include "model/network/discriminator.h"

namespace duet::network {
namespace {

// Two joints, two clips; the second has one frame, then padding.
const torch::Tensor kLengths = torch::tensor({3, 1}, torch::kInt64);

torch::Tensor Zeros() { return torch::zeros({2, 3, 6}); }

torch::Tensor WithBadPadding(torch::Tensor motion) {
  motion[1].narrow(0, 1, 2).fill_(100);
  return motion;
}

TEST(LossTest, L1SumsCoordinatesAndAveragesFrames) {
  torch::Tensor predicted = WithBadPadding(Zeros());
  predicted[0][0][0] = 3;
  predicted[0][2][5] = -4;
  predicted[1][0][1] = 1;
  EXPECT_FLOAT_EQ(L1Loss(predicted, Zeros(), kLengths).item<float>(), (3 + 4 + 1) / 4.0f);
}

TEST(LossTest, NormIsEuclideanOverAllCoordinates) {
  torch::Tensor predicted = WithBadPadding(Zeros());
  predicted[0][0][0] = 3;
  predicted[0][0][5] = 4;
  EXPECT_NEAR(NormLoss(predicted, Zeros(), kLengths).item<float>(), 5 / 4.0, 1e-5);
}

TEST(LossTest, BoneIsRelativeToTheRealLength) {
  torch::Tensor real = Zeros(), predicted = WithBadPadding(Zeros());
  real.slice(2, 3, 4).fill_(2);       // joint 1 at x = 2: length 2
  predicted.slice(2, 3, 4).fill_(3);  // length 3
  predicted[1].narrow(0, 1, 2).fill_(50);
  EXPECT_NEAR(BoneLoss(predicted, real, kLengths, {{0, 1}}).item<float>(), 0.5, 1e-6);
}

TEST(LossTest, ContinuityHingeByHand) {
  // Joint 0 moves 1 m along x, and comes back: |x2 - x1| = 1, |x2 - x0| = 0; joint 1 rests.
  torch::Tensor moving = Zeros();
  moving[0][1][0] = 1;
  // [1 - 0 + 0.1]_+ over the one valid frame with a frame two before it
  EXPECT_NEAR(ContinuityLoss(moving, kLengths, ContinuityForm::kHinge).item<float>(), 1.1, 1e-5);
  moving[0][2][0] = 4;  // goes on: [3 - 4 + 0.1]_+
  EXPECT_NEAR(ContinuityLoss(moving, kLengths, ContinuityForm::kHinge).item<float>(), 0, 1e-6);
}

TEST(LossTest, ContinuityPathLengthByHand) {
  torch::Tensor moving = WithBadPadding(Zeros());
  moving[0][1][0] = 1;
  moving[0][2][0] = 4;
  EXPECT_NEAR(ContinuityLoss(moving, kLengths, ContinuityForm::kPathLength).item<float>(), 2, 1e-5);
}

TEST(LossTest, AdversarialTermsByHand) {
  const torch::Tensor logits =
      torch::zeros({2, 4});  // uniform over three classes and "synthesised"
  const torch::Tensor classes = torch::tensor({0, 2}, torch::kInt64);
  EXPECT_NEAR(DiscriminatorLoss(logits, logits, classes).item<float>(), 2 * std::log(4.0), 1e-5);
  EXPECT_NEAR(AdversarialLoss(logits, classes).item<float>(), std::log(4.0), 1e-5);
  torch::Tensor sure = torch::zeros({2, 4});
  sure[0][0] = 50;
  sure[1][2] = 50;
  EXPECT_NEAR(AdversarialLoss(sure, classes).item<float>(), 0, 1e-5);
  EXPECT_NEAR(DiscriminatorLoss(sure, sure, classes).item<float>(), 50, 1e-3);
}

TEST(LossTest, GradientsAreFiniteWhereDistancesVanish) {
  torch::Tensor motion = Zeros().requires_grad_();
  (ContinuityLoss(motion, kLengths, ContinuityForm::kHinge) +
   BoneLoss(motion, Zeros() + 1e-3, kLengths, {{0, 1}}) + NormLoss(motion, Zeros(), kLengths))
      .backward();
  EXPECT_TRUE(torch::isfinite(motion.grad()).all().item<bool>());
}

TEST(DiscriminatorTest, PaddingHasNoInfluenceAndBatchEqualsSingle) {
  torch::manual_seed(5);
  Discriminator discriminator(DiscriminatorOptions{6, 8, 5, 4});
  discriminator->eval();
  torch::NoGradGuard no_grad;
  torch::Tensor motion = torch::randn({2, 7, 6});
  const torch::Tensor lengths = torch::tensor({7, 3}, torch::kInt64);
  const torch::Tensor before = discriminator->forward(motion, lengths);
  motion[1].narrow(0, 3, 4).fill_(9);
  EXPECT_TRUE(torch::allclose(discriminator->forward(motion, lengths), before));
  const torch::Tensor alone =
      discriminator->forward(motion[1].narrow(0, 0, 3).unsqueeze(0), lengths.narrow(0, 1, 1));
  EXPECT_TRUE(torch::allclose(alone[0], before[1], 1e-5, 1e-6));
  EXPECT_EQ(discriminator->Features(motion, lengths).sizes(), at::IntArrayRef({2, 10}));
}

}  // namespace
}  // namespace duet::network

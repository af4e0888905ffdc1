#include "model/training/adversary.h"

#include <gmock/gmock.h>

#include "tests/training/made_up_dataset.h"
#include "tests/training/test_options.h"

namespace duet::training {
namespace {

class AdversaryTest : public ::testing::Test {
 protected:
  AdversaryTest() {
    torch::set_num_threads(1);
    torch::manual_seed(3);
    PaperOf(&options_).graded_labels = 0;
    batch_ = SampleEpoch(manifest_, dataset_, AllOf(dataset_), options_, 0).front();
    synthesised_ = torch::randn_like(batch_.follower);
  }

  Adversary Make() { return {options_, manifest_, 100}; }

  dataset::Dataset dataset_ = MadeUpDataset();
  TrainingOptions options_ = SmallOptions();
  checkpoint::Manifest manifest_ = ManifestFor(options_, dataset_);
  TrainingBatch batch_;
  torch::Tensor synthesised_;
};

TEST_F(AdversaryTest, GeneratorLossGivesNoGradientToTheDiscriminators) {
  Adversary adversary = Make();
  synthesised_.set_requires_grad(true);
  adversary.GeneratorLoss(batch_, synthesised_).backward();
  EXPECT_GT(synthesised_.grad().abs().max().item<double>(), 0);
  for (const auto& [name, tensor] : adversary.Tensors()) {
    EXPECT_FALSE(tensor.grad().defined()) << name;
  }
}

TEST_F(AdversaryTest, TrainingSeparatesSynthesisedFromCaptured) {
  options_.optimiser.schedule = "constant";
  PaperOf(&options_).discriminator.learning_rate = 0.02;
  Adversary adversary = Make();
  const double before = adversary.GeneratorLoss(batch_, synthesised_).item<double>();
  for (int step = 0; step < 30; ++step) adversary.Train(batch_, synthesised_, step);
  EXPECT_GT(adversary.GeneratorLoss(batch_, synthesised_).item<double>(), before);
}

TEST_F(AdversaryTest, BinaryDiscriminatorAddsItsLoss) {
  torch::manual_seed(4);
  Adversary alone = Make();
  PaperOf(&options_).discriminator.binary = true;
  torch::manual_seed(4);  // the same class-aware discriminator
  Adversary both = Make();
  EXPECT_EQ(both.Tensors().size(), 2 * alone.Tensors().size());
  EXPECT_GT(both.GeneratorLoss(batch_, synthesised_).item<double>(),
            alone.GeneratorLoss(batch_, synthesised_).item<double>());
  const torch::Tensor binary = both.Tensors().back().second.clone();
  both.Train(batch_, synthesised_, 0);
  EXPECT_FALSE(torch::equal(binary, both.Tensors().back().second));
}

TEST_F(AdversaryTest, IgnoresMixedAnswers) {
  Adversary adversary = Make();
  batch_.single_rows = torch::empty({0}, torch::kInt64);
  EXPECT_EQ(adversary.GeneratorLoss(batch_, synthesised_).item<double>(), 0);
}

}  // namespace
}  // namespace duet::training

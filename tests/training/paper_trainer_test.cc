#include "model/training/paper_trainer.h"

#include <gmock/gmock.h>

#include <set>
#include <string>

#include "absl/strings/str_cat.h"
#include "model/network/losses.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"
#include "tests/training/made_up_dataset.h"
#include "tests/training/test_options.h"

namespace duet::training {
namespace {

using test::ReadTestFile;
using test::TemporaryFolder;
using test::WriteTestFile;

class PaperTrainerTest : public ::testing::Test {
 protected:
  PaperTrainerTest() { torch::set_num_threads(1); }

  PaperTrainer Make() { return {options_, manifest_, dataset_, AllOf(dataset_), {}}; }

  dataset::Dataset dataset_ = MadeUpDataset();
  TrainingOptions options_ = SmallOptions();
  checkpoint::Manifest manifest_ = ManifestFor(options_, dataset_);
  TemporaryFolder folder_;
};

bool Equal(const std::vector<checkpoint::Tensor>& a, const std::vector<checkpoint::Tensor>& b) {
  for (size_t i = 0; i < a.size(); ++i) {
    if (a[i].values != b[i].values) return false;
  }
  return a.size() == b.size();
}

TEST_F(PaperTrainerTest, ResumedRunEqualsAnUninterruptedOneBitForBit) {
  PaperTrainer straight = Make();
  for (int i = 0; i < 4; ++i) straight.RunEpoch();
  {
    PaperTrainer first = Make();
    first.RunEpoch();
    first.RunEpoch();
    ASSERT_THAT(first.SaveState(folder_ / "state"), IsOk());
  }
  PaperTrainer resumed = Make();
  ASSERT_THAT(resumed.LoadState(folder_ / "state"), IsOk());
  EXPECT_EQ(resumed.epoch(), 2);
  resumed.RunEpoch();
  EXPECT_FALSE(Equal(resumed.BestTensors(), straight.BestTensors()));
  resumed.RunEpoch();
  EXPECT_TRUE(Equal(resumed.BestTensors(), straight.BestTensors()));
  EXPECT_TRUE(resumed.Finished());
}

TEST_F(PaperTrainerTest, TrainsOnlyOnTheProcessor) {
  PaperTrainer trainer = Make();
  EXPECT_THAT(trainer.UseDevice("cpu"), IsOk());
  EXPECT_THAT(trainer.UseDevice("cuda"),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("device: expected cpu")));
}

TEST_F(PaperTrainerTest, StateOfAnotherRunIsRejected) {
  PaperTrainer trainer = Make();
  ASSERT_THAT(trainer.SaveState(folder_ / "state"), IsOk());
  const std::string bone = Describe(options_).at("losses.bone");
  options_.paper.mutable_losses()->set_bone(0.5);
  EXPECT_THAT(Make().LoadState(folder_ / "state"),
              StatusIs(absl::StatusCode::kFailedPrecondition,
                       HasSubstr(absl::StrCat("other options or data: expected losses.bone=", bone,
                                              ", got losses.bone=0.5; use the same"))));
}

TEST_F(PaperTrainerTest, TornOrMissingStateIsAnError) {
  EXPECT_THAT(Make().LoadState(folder_ / "state"),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr("state")));
  PaperTrainer trainer = Make();
  ASSERT_THAT(trainer.SaveState(folder_ / "state"), IsOk());
  const std::string whole = ReadTestFile(folder_ / "state");
  WriteTestFile(folder_ / "state", whole.substr(0, whole.size() / 2));
  EXPECT_THAT(Make().LoadState(folder_ / "state"),
              StatusIs(absl::StatusCode::kDataLoss, HasSubstr("state")));
}

TEST_F(PaperTrainerTest, OverfitsOneClip) {
  options_.paper.clear_dropout();
  options_.common.clear_augmentation();
  options_.paper.set_graded_labels(0);
  options_.paper.clear_losses();
  PaperOf(&options_).encoder_hidden = 12;
  Change("optimiser { learning_rate: 0.01 } epochs: 300", &options_.common);
  manifest_ = ManifestFor(options_, dataset_);
  PaperTrainer trainer(options_, manifest_, dataset_, {2}, {});
  const double before = trainer.RunEpoch().reconstruction;
  double after = before;
  while (!trainer.Finished()) after = trainer.RunEpoch().reconstruction;
  EXPECT_LT(after, before / 5);
}

TEST_F(PaperTrainerTest, EpochUsesEverySequenceOnce) {
  options_.common.clear_augmentation();
  std::multiset<float> seen;
  for (const TrainingBatch& batch :
       SampleEpoch(manifest_, dataset_, AllOf(dataset_), options_, 3)) {
    for (int64_t n = 0; n < batch.classes.size(0); ++n) {
      seen.insert(batch.input.lengths[n].item<float>());
    }
    EXPECT_LE(batch.classes.size(0), options_.common.batch());
  }
  std::multiset<float> wanted;
  for (const dataset::Sequence& s : dataset_.sequences) {
    wanted.insert(static_cast<float>(s.pair.leader.frame_count()));
  }
  EXPECT_EQ(seen, wanted);
}

TEST_F(PaperTrainerTest, BatchIsInTheLeadersFrameWithItsLabelAndStart) {
  const TrainingBatch batch =
      MakeBatch(manifest_, dataset_,
                {CapturedExample(dataset_, dataset_.sequences[4], StartKnowledge::kRoot)});
  const int root = dataset_.skeleton.root;
  EXPECT_LT(batch.input.leader[0].narrow(1, 3 * root, 3).abs().max().item<float>(), 1e-6);
  // The partner stands towards +z in the world: -z in the standard coordinates.
  EXPECT_LT(batch.follower[0][0][3 * root + 2].item<float>(), -0.5);
  EXPECT_EQ(batch.input.labels[0][0][1].item<float>(), 1);
  EXPECT_EQ(batch.input.labels[0][0].sum().item<float>(), 1);
  const int64_t width = batch.input.start.size(1);
  EXPECT_EQ(batch.input.start[0][width - 2].item<float>(), 1);
  EXPECT_EQ(batch.input.start[0][width - 1].item<float>(), 0);
  EXPECT_TRUE(torch::allclose(batch.input.start[0].narrow(0, 0, 3),
                              batch.follower[0][0].narrow(0, 3 * root, 3)));
}

TEST(ScheduleTest, OneCycleRisesAndFalls) {
  CommonSettings::Optimiser options;
  EXPECT_NEAR(ScheduleFactor(options, 0, 100), 0.04, 1e-9);
  EXPECT_NEAR(ScheduleFactor(options, 20, 100), 1, 1e-9);
  EXPECT_NEAR(ScheduleFactor(options, 60, 100), 0.5, 1e-3);
  EXPECT_LT(ScheduleFactor(options, 99, 100), 0.01);
  options.set_schedule(CONSTANT);
  EXPECT_EQ(ScheduleFactor(options, 99, 100), 1);
}

TEST(ScheduleTest, CosineWarmsUpAndFallsToItsLastShare) {
  const auto options =
      Settings<CommonSettings::Optimiser>("schedule: COSINE warm_up_steps: 10 last_share: 0.1");
  EXPECT_NEAR(ScheduleFactor(options, 0, 1000), 0.1, 1e-3);
  EXPECT_NEAR(ScheduleFactor(options, 9, 1000), 1, 1e-3);
  EXPECT_NEAR(ScheduleFactor(options, 500, 1000), 0.55, 1e-3);
  EXPECT_NEAR(ScheduleFactor(options, 1000, 1000), 0.1, 1e-9);
}

class AdversaryTest : public ::testing::Test {
 protected:
  AdversaryTest() {
    torch::set_num_threads(1);
    torch::manual_seed(3);
    options_.paper.set_graded_labels(0);
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

TEST_F(AdversaryTest, BinaryDiscriminatorAddsItsLoss) {
  torch::manual_seed(4);
  Adversary alone = Make();
  options_.paper.mutable_discriminator()->set_binary(true);
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

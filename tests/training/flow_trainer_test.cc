#include "model/training/flow_trainer.h"

#include <gmock/gmock.h>

#include <cmath>
#include <utility>

#include "model/network/batch.h"
#include "model/training/flow_batches.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"
#include "tests/training/flow_test_options.h"
#include "tests/training/made_up_dataset.h"

namespace duet::training {
namespace {

using test::TemporaryFolder;

bool Equal(const std::vector<checkpoint::Tensor>& a, const std::vector<checkpoint::Tensor>& b) {
  for (size_t i = 0; i < a.size(); ++i) {
    if (a[i].values != b[i].values) return false;
  }
  return a.size() == b.size();
}

class FlowTrainerTest : public ::testing::Test {
 protected:
  FlowTrainerTest() { torch::set_num_threads(1); }

  FlowTrainer Make(std::vector<int> validation = {}) {
    return {options_, manifest_, dataset_, AllOf(dataset_), std::move(validation)};
  }
  std::vector<FlowBatch> Sample(int64_t epoch) {
    std::vector<FlowBatch> batches;
    for (const auto& examples :
         DrawFlowEpoch(manifest_, dataset_, AllOf(dataset_), options_, epoch)) {
      batches.push_back(MakeFlowBatch(manifest_, base_poses_, examples));
    }
    return batches;
  }

  dataset::Dataset dataset_ = MadeUpDataset();
  TrainingOptions options_ = SmallFlowOptions();
  checkpoint::Manifest manifest_ = ManifestFor(options_, dataset_);
  torch::Tensor base_poses_ = torch::zeros({3, 45});
  TemporaryFolder folder_;
};

TEST_F(FlowTrainerTest, ResumedRunEqualsAnUninterruptedOneBitForBit) {
  // With all that is drawn at random.
  Change("start { root: 0 pose: 1 }", &options_.common);
  Change(R"(
      flow { several_known: 1 }
      own { share: 0.5 } live { share: 0.5 } drift { share: 0.5 }
      stillness { pauses: 0.5 ends: 0.2 motionless: 0.2 unlabelled: 0.2 clean: 0.5 }
      energy { from: 0.5 })",
         &options_.flow);
  FlowTrainer straight = Make();
  for (int i = 0; i < 4; ++i) straight.RunEpoch();
  {
    FlowTrainer first = Make();
    first.RunEpoch();
    first.RunEpoch();
    ASSERT_THAT(first.SaveState(folder_ / "state"), IsOk());
  }
  FlowTrainer resumed = Make();
  ASSERT_THAT(resumed.LoadState(folder_ / "state"), IsOk());
  EXPECT_EQ(resumed.epoch(), 2);
  resumed.RunEpoch();
  EXPECT_FALSE(Equal(resumed.BestTensors(), straight.BestTensors()));
  resumed.RunEpoch();
  EXPECT_TRUE(Equal(resumed.BestTensors(), straight.BestTensors()));
  EXPECT_TRUE(resumed.Finished());
}

TEST_F(FlowTrainerTest, DirectionIsStatedInHalfOfTheClipsWithoutAStart) {
  for (dataset::Sequence& sequence : dataset_.sequences) sequence.partner_direction.reset();
  Change("augmentation { noise: 0 } start { root: 0 pose: 0 }", &options_.common);
  Change("flow { passes: 60 }", &options_.flow);
  const auto [left, right] = *dataset_.skeleton.hips;
  const auto in_the_frame_of_the_hips = [&, left = left, right = right] {
    int hips = 0, all = 0;
    for (const auto& batch : DrawFlowEpoch(manifest_, dataset_, AllOf(dataset_), options_, 0)) {
      for (const FlowExample& example : batch) {
        const motion::Vec3 across =
            example.input.leader.at(0, right) - example.input.leader.at(0, left);
        hips += std::abs(across.z) < 1e-4f;
        ++all;
      }
    }
    return static_cast<double>(hips) / all;
  };
  EXPECT_NEAR(in_the_frame_of_the_hips(), 0.5, 0.1);
  Change("start { pose: 1 }", &options_.common);  // which states it
  EXPECT_EQ(in_the_frame_of_the_hips(), 0);
}

TEST_F(FlowTrainerTest, ClipsOfStillnessHaveTheirStartsAndLabels) {
  Change("stillness { motionless: 0.5 unlabelled: 0.4 } flow { unlabelled: 0 passes: 40 }",
         &options_.flow);
  options_.common.clear_start();
  int unlabelled = 0, told = 0, all = 0;
  for (const auto& batch : DrawFlowEpoch(manifest_, dataset_, AllOf(dataset_), options_, 0)) {
    for (const FlowExample& example : batch) {
      unlabelled += example.unlabelled;
      told += example.input.start.has_value();
      ++all;
    }
  }
  EXPECT_NEAR(unlabelled, 0.4 * all, 0.1 * all);
  EXPECT_NEAR(told, 0.45 * all, 0.1 * all);  // those in the midst, without whom nobody is told
}

TEST_F(FlowTrainerTest, LearnsToAnswer) {
  Change("epochs: 12 optimiser { warm_up_steps: 5 }", &options_.common);
  Change("flow { passes: 10 bone_weight: 1 } energy { from: 1 }", &options_.flow);
  FlowTrainer trainer = Make({0});
  const EpochReport before = trainer.RunEpoch();
  EpochReport after;
  while (!trainer.Finished()) after = trainer.RunEpoch();
  EXPECT_LT(after.generator, 0.7 * before.generator);
  EXPECT_LT(after.validation_afd_pose, before.validation_afd_pose);
  EXPECT_GT(before.bone, 0);
  EXPECT_GT(before.continuity, 0);
}

TEST_F(FlowTrainerTest, EnergyScoreHasNoDropout) {
  options_.flow.mutable_energy()->set_from(0);
  options_.flow.mutable_flow()->set_dropout(0.1);
  const double loss = Make().RunEpoch().generator;
  options_.flow.mutable_flow()->set_dropout(0.5);
  EXPECT_EQ(Make().RunEpoch().generator, loss);
}

TEST_F(FlowTrainerTest, FewClipsGetMorePassesUntilTheLeastSteps) {
  // 7 sequences in batches of 3: 3 steps a pass; 4 epochs.
  options_.flow.mutable_flow()->set_passes(2);
  options_.flow.mutable_flow()->set_least_steps(24);
  EXPECT_EQ(PassesPerEpoch(options_, 7), 2);
  EXPECT_EQ(StepsPerEpoch(options_, 7), 6);
  options_.flow.mutable_flow()->set_least_steps(25);
  EXPECT_EQ(PassesPerEpoch(options_, 7), 3);
  EXPECT_EQ(StepsPerEpoch(options_, 7), 9);
  EXPECT_EQ(Make().steps_per_epoch(), 9);
  EXPECT_EQ(Sample(0).size(), 9u);
  EXPECT_EQ(PassesPerEpoch(options_, 300), 2);  // enough as they are
}

TEST_F(FlowTrainerTest, KeepsTheBestOfTheEpochsThatScoreWholeAnswers) {
  options_.common.set_epochs(6);
  options_.common.mutable_optimiser()->set_learning_rate(
      0);  // all epochs are equally good: the first choice stays
  options_.flow.mutable_energy()->set_from(0.5);
  FlowTrainer trainer = Make({0});
  std::vector<int64_t> best;
  std::vector<bool> scored;
  while (!trainer.Finished()) {
    scored.push_back(trainer.RunEpoch().whole_answers);
    best.push_back(trainer.best_epoch());
  }
  EXPECT_EQ(scored, (std::vector<bool>{false, false, false, true, true, true}));
  EXPECT_EQ(best, (std::vector<int64_t>{1, 2, 3, 4, 4, 4}));
  options_.flow.mutable_energy()->set_from(1);
  FlowTrainer matching = Make({0});
  while (!matching.Finished()) matching.RunEpoch();
  EXPECT_EQ(matching.best_epoch(), 1);
}

TEST_F(FlowTrainerTest, CheckpointHasItsShareOfTheNoise) {
  const auto noise = [this](double share) {
    options_.flow.mutable_flow()->set_noise_share(share);
    for (const checkpoint::Tensor& tensor : Make().BestTensors()) {
      if (tensor.name == "noise.roots") return tensor.values;
    }
    return std::vector<float>();
  };
  const std::vector<float> all = noise(1), half = noise(0.5);
  ASSERT_FALSE(all.empty());
  for (size_t i = 0; i < all.size(); ++i) EXPECT_FLOAT_EQ(half[i], all[i] / 2);
}

TEST_F(FlowTrainerTest, DrawsEveryKindOfStartWithItsProbability) {
  Change("start { root: 0.25 pose: 0.5 }", &options_.common);
  Change("flow { several_known: 0.5 unlabelled: 0.2 passes: 40 }", &options_.flow);
  double clips = 0, roots = 0, poses = 0, several = 0, unlabelled = 0;
  for (const FlowBatch& batch : Sample(0)) {
    const int64_t width = batch.input.start.size(1);
    clips += static_cast<double>(batch.target.size(0));
    roots += batch.input.start.select(1, width - 2).sum().item<double>();
    poses += batch.input.start.select(1, width - 1).sum().item<double>();
    several += (batch.input.known_count > 1).sum().item<double>();
    unlabelled += (batch.labels.sum(1) == 0).sum().item<double>();
    EXPECT_TRUE(
        (2 * batch.input.known_count <= batch.input.lengths.clamp_min(2)).all().item<bool>());
  }
  EXPECT_NEAR(roots / clips, 0.75, 0.08);
  EXPECT_NEAR(poses / clips, 0.5, 0.08);
  EXPECT_NEAR(several / clips, 0.25, 0.08);
  EXPECT_NEAR(unlabelled / clips, 0.2, 0.08);
}

TEST_F(FlowTrainerTest, LiveClipsHaveSeveralKnownFramesAndHideTheLeadersFuture) {
  options_.common.clear_start();
  Change("live { share: 1 several_known: 1 delay_seconds: 0 }", &options_.flow);
  for (const FlowBatch& batch : Sample(0)) {
    EXPECT_TRUE(batch.live.all().item<bool>());
    EXPECT_GE(batch.input.known_count.min().item<int64_t>(), 2);
    EXPECT_TRUE(batch.input.is_hidden.any().item<bool>());
  }
}

TEST_F(FlowTrainerTest, MeasuresMeanPosesAndOffsetsOfTheFollowers) {
  const FlowStatistics statistics = MeasureFollowers(manifest_, dataset_, AllOf(dataset_), 0);
  const int64_t root = 3 * dataset_.skeleton.root;
  // One metre in front of the leader; each class is higher than the previous one.
  EXPECT_NEAR(statistics.base_poses[0][root + 2].item<float>(), -1, 0.3);
  EXPECT_NEAR((statistics.base_poses[2] - statistics.base_poses[0])[root + 1].item<float>(), 0.2,
              0.05);
  // With mirrored copies, the mean sideways position is 0.
  EXPECT_NEAR(statistics.base_poses[0][root].item<float>(), 0, 1e-4);
  for (const int64_t state : {0, 1}) {
    const torch::Tensor root_of = statistics.noise_roots[state];
    EXPECT_TRUE(torch::allclose(root_of, root_of.t(), 0, 1e-4));
    EXPECT_GT(root_of.abs().max().item<float>(), 0.01);
  }
}

TEST_F(FlowTrainerTest, ClassBalanceCountsErrorsRelativeToTheSpreadOfTheClass) {
  // The people of the last class are much larger, so their errors are too.
  for (dataset::Sequence& sequence : dataset_.sequences) {
    if (sequence.interaction_class != 2) continue;
    for (motion::Poses* poses : {&sequence.pair.leader.poses, &sequence.pair.follower.poses}) {
      for (motion::Vec3& point : poses->all()) point = point * 10;
    }
  }
  const torch::Tensor spreads = MeasureFollowers(manifest_, dataset_, AllOf(dataset_), 0).spreads;
  EXPECT_NEAR((spreads[2] / spreads[0]).item<float>(), 10, 1);
  options_.flow.mutable_energy()->set_from(0);
  const double in_metres = Make().RunEpoch().reconstruction;
  options_.flow.mutable_flow()->set_class_balance(1);
  // The weights of the classes are 1.4, 1.4 and .14.
  EXPECT_LT(Make().RunEpoch().reconstruction, in_metres);
}

}  // namespace
}  // namespace duet::training

#include "model/training/run.h"

#include <gmock/gmock.h>

#include <cmath>
#include <sstream>

#include "absl/strings/str_format.h"
#include "absl/strings/str_split.h"
#include "model/checkpoint/architecture.h"
#include "model/cpu_engine/cpu_synthesizer.h"
#include "model/training/options.h"
#include "model/training/sampler.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"
#include "tests/training/flow_test_options.h"
#include "tests/training/made_up_dataset.h"

namespace duet::training {
namespace {

using test::ReadTestFile;
using test::TemporaryFolder;

class RunTest : public ::testing::Test {
 protected:
  RunTest() {
    plan_.options = SmallOptions();
    plan_.model_name = "made_up";
    plan_.title = "all";
    plan_.folder = folder_.path() / "run";
    plan_.train = AllOf(dataset_);
  }

  absl::Status Go() { return RunTraining(plan_, dataset_, false, &progress_); }

  // Trains, and returns the result.
  checkpoint::Checkpoint Train() {
    EXPECT_THAT(Go(), IsOk());
    absl::StatusOr<checkpoint::Checkpoint> read =
        checkpoint::ReadCheckpoint(CheckpointFolder(plan_));
    EXPECT_THAT(read, IsOk());
    return read.ok() ? *std::move(read) : checkpoint::Checkpoint();
  }

  // Trains the sampling generator for one epoch.
  void UseFlow() {
    plan_.options = SmallFlowOptions();
    plan_.options.common.set_epochs(1);
  }

  dataset::Dataset dataset_ = MadeUpDataset();
  TemporaryFolder folder_;
  RunPlan plan_;
  std::ostringstream progress_;
};

TEST_F(RunTest, WritesACheckpointThatAnswers) {
  ASSERT_THAT(Go(), IsOk());
  const auto synthesizer = cpu_engine::LoadCpuSynthesizer(CheckpointFolder(plan_));
  ASSERT_THAT(synthesizer, IsOk());
  const engine::ModelDescription& model = (*synthesizer)->description();
  EXPECT_EQ(model.classes, dataset_.classes);
  EXPECT_EQ(model.window_frames, dataset_.LongestFrameCount());
  EXPECT_TRUE(model.accepts_follower_start);
  EXPECT_FALSE(model.partner_direction.has_value());  // the paper's generator uses the hips
  EXPECT_THAT(progress_.str(), HasSubstr("epoch 4/4"));
  const auto checkpoint = checkpoint::ReadCheckpoint(CheckpointFolder(plan_));
  ASSERT_THAT(checkpoint, IsOk());
  EXPECT_EQ(checkpoint->manifest.training.at("losses.bone"), "0.01");
  EXPECT_EQ(checkpoint->manifest.training.at("sequences"), "7");
}

TEST_F(RunTest, LongTakesAreTrainedOnInWindows) {
  UseFlow();
  Change("flow { window_seconds: 0.4 stride_seconds: 0.2 lookahead_seconds: 0.2 }",  // 6, 3 frames
         &plan_.options.flow);
  for (dataset::Sequence& take : dataset_.sequences) {
    take.labels = {{take.interaction_class, 0, 6}, {2, 4, take.pair.leader.frame_count()}};
  }
  const checkpoint::Checkpoint checkpoint = Train();
  EXPECT_EQ(checkpoint.manifest.model.window_frames, 6);
  EXPECT_EQ(checkpoint.manifest.model.lookahead_frames, 3);  // at 15 Hz
  EXPECT_EQ(checkpoint.manifest.training.at("sequences"), "7");
  EXPECT_EQ(checkpoint.manifest.training.at("flow.window_seconds"), "0.4");
}

TEST_F(RunTest, TrainsACriticAfterTheGenerator) {
  UseFlow();
  const checkpoint::Checkpoint plain = Train();
  EXPECT_TRUE(plain.critic.empty());
  Change("critic { steps: 60 answers: 2 }", &plan_.options.flow);
  plan_.folder = folder_.path() / "with";
  ASSERT_THAT(Go(), IsOk());
  EXPECT_THAT(progress_.str(), HasSubstr("all: critic: loss "));
  const auto with = checkpoint::ReadCheckpoint(CheckpointFolder(plan_));
  ASSERT_THAT(with, IsOk());
  EXPECT_EQ(with->tensors[0].values, plain.tensors[0].values);
  EXPECT_TRUE(checkpoint::CriticOf(*with).has_value());
  EXPECT_EQ(with->manifest.training.at("critic.steps"), "60");
  // A generator of one epoch is easily told from people.
  EXPECT_LT(with->manifest.metrics.at("training.critic"), 0.6);
}

TEST_F(RunTest, BeginsWithTheWeightsOfACheckpoint) {
  for (const TrainingOptions& options : {SmallOptions(), SmallFlowOptions()}) {
    SCOPED_TRACE(options.architecture.index());
    plan_.options = options;
    plan_.options.common.set_epochs(1);
    plan_.from.clear();
    plan_.folder = folder_.path() / absl::StrCat("first", options.architecture.index());
    ASSERT_THAT(Go(), IsOk());
    plan_.from = CheckpointFolder(plan_);
    plan_.folder = folder_.path() / absl::StrCat("second", options.architecture.index());
    plan_.options.common.mutable_optimiser()->set_learning_rate(1e-9);  // keeps the weights
    ASSERT_THAT(Go(), IsOk());
    const auto first = checkpoint::ReadCheckpoint(plan_.from);
    const auto second = checkpoint::ReadCheckpoint(CheckpointFolder(plan_));
    ASSERT_THAT(first, IsOk());
    ASSERT_THAT(second, IsOk());
    for (size_t i = 0; i < first->tensors.size(); ++i) {
      const checkpoint::Tensor &before = first->tensors[i], &after = second->tensors[i];
      for (size_t v = 0; v < before.values.size(); ++v) {
        ASSERT_NEAR(before.values[v], after.values[v], 1e-4) << before.name;
      }
    }
    EXPECT_EQ(second->manifest.training.at("from"), "made_up@1 " + first->manifest.weights.sha256);
  }
}

TEST_F(RunTest, RejectsTheCheckpointOfAnotherModel) {
  plan_.options.common.set_epochs(1);
  ASSERT_THAT(Go(), IsOk());
  plan_.from = CheckpointFolder(plan_);
  plan_.folder = folder_.path() / "other";
  plan_.options = SmallFlowOptions();
  EXPECT_THAT(Go(), StatusIs(absl::StatusCode::kInvalidArgument,
                             HasSubstr("expected the architecture of the options")));
  dataset_.classes.back() = "waltz";
  EXPECT_THAT(Go(), StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("waltz")));
  plan_.from = folder_.path() / "nowhere";
  EXPECT_THAT(Go(), StatusIs(absl::StatusCode::kNotFound, HasSubstr("nowhere")));
}

TEST_F(RunTest, SamplingGeneratorWritesACheckpointThatAnswers) {
  plan_.options = SmallFlowOptions();
  ASSERT_THAT(Go(), IsOk());
  const auto synthesizer = cpu_engine::LoadCpuSynthesizer(CheckpointFolder(plan_));
  ASSERT_THAT(synthesizer, IsOk());
  EXPECT_TRUE((*synthesizer)->description().samples);
  EXPECT_TRUE((*synthesizer)->description().partner_direction.has_value());
  EXPECT_TRUE((*synthesizer)->description().accepts_follower_start);
  engine::SynthesisWindow window =
      MakeWindow(dataset_, CapturedExample(dataset_, dataset_.sequences[0], StartKnowledge::kPose));
  const engine::SynthesisWindow* const one = &window;
  const auto first = (*synthesizer)->Synthesize({&one, 1});
  ASSERT_THAT(first[0], IsOk());
  EXPECT_EQ(first[0]->frame_count(), window.leader.frame_count());
  window.options.sampling.seed = 1;
  const auto second = (*synthesizer)->Synthesize({&one, 1});
  ASSERT_THAT(second[0], IsOk());
  EXPECT_NE(*first[0], *second[0]);
}

TEST_F(RunTest, FinishedRunIsNotRepeated) {
  ASSERT_THAT(Go(), IsOk());
  progress_.str("");
  ASSERT_THAT(Go(), IsOk());
  EXPECT_THAT(progress_.str(), HasSubstr("is finished"));
}

TEST_F(RunTest, DivergenceIsReportedNotSaved) {
  dataset_.sequences[0].pair.follower.at(0, 0).x = 1e38f;  // the losses overflow a float
  EXPECT_THAT(Go(), StatusIs(absl::StatusCode::kInternal, HasSubstr("no longer finite")));
  EXPECT_FALSE(std::filesystem::exists(CheckpointFolder(plan_)));
  EXPECT_FALSE(std::filesystem::exists(plan_.folder / "state"));
}

TEST_F(RunTest, ValidatesOnHeldOutSubjects) {
  Change("validation { subjects: 's02' }", &plan_.options.common);
  const checkpoint::Checkpoint checkpoint = Train();
  const auto& metrics = checkpoint.manifest.metrics;
  EXPECT_GT(metrics.at("validation.afd"), 0);
  EXPECT_GE(metrics.at("validation.epoch"), 1);
  EXPECT_THAT(progress_.str(), HasSubstr(absl::StrFormat(
                                   "all: epoch %.0f of 4 is kept: least error on what was held "
                                   "back, %.4f m\n",
                                   metrics.at("validation.epoch"), metrics.at("validation.afd"))));
  plan_.folder = folder_.path() / "nothing_left";
  Change("validation { subjects: [ 's01', 's02' ] }", &plan_.options.common);
  EXPECT_THAT(Go(), StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("every sequence")));
}

TEST_F(RunTest, TellsItsLengthAndWhyTheLossJumps) {
  plan_.options = SmallFlowOptions();  // 4 epochs of 2 passes of 3 steps
  plan_.options.flow.mutable_energy()->set_from(0.5);
  ASSERT_THAT(Go(), IsOk());
  EXPECT_THAT(progress_.str(), HasSubstr("all: 7 sequences, 24 steps\n"));
  EXPECT_THAT(progress_.str(), HasSubstr("left\nall: from epoch 3 the loss is the score of whole "
                                         "answers (energy.from), on another scale than before\n"
                                         "all [############"));
  EXPECT_THAT(progress_.str(), Not(HasSubstr("from epoch 4")));
  EXPECT_THAT(progress_.str(), Not(HasSubstr("held back")));
  const std::string log = ReadTestFile(plan_.folder / "log.csv");
  EXPECT_THAT(log, HasSubstr(",seconds,whole_answers\n1,"));
  std::vector<std::string> rows = absl::StrSplit(log, '\n', absl::SkipEmpty());
  ASSERT_EQ(rows.size(), 5u);
  for (size_t epoch = 1; epoch <= 4; ++epoch) {
    EXPECT_EQ(rows[epoch].back(), epoch <= 2 ? '0' : '1') << epoch;
  }
}

TEST_F(RunTest, InvalidManifestIsRejectedBeforeTraining) {
  plan_.model_name = "my studio";
  EXPECT_THAT(Go(), StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("\"my studio\"")));
  EXPECT_FALSE(std::filesystem::exists(plan_.folder));
}

TEST_F(RunTest, ResumingDropsRowsOfLostEpochs) {
  ASSERT_THAT(Go(), IsOk());
  std::filesystem::remove_all(CheckpointFolder(plan_));
  const std::string log = ReadTestFile(plan_.folder / "log.csv");
  test::WriteTestFile(plan_.folder / "log.csv", log + "5,lost\n");
  ASSERT_THAT(Go(), IsOk());
  EXPECT_EQ(ReadTestFile(plan_.folder / "log.csv"), log);
}

}  // namespace
}  // namespace duet::training

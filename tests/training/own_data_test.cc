// Your own data set, from files to a follower: imports, trains, loads and synthesises.
#include <gmock/gmock.h>

#include <cmath>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "model/cpu_engine/cpu_synthesizer.h"
#include "model/dataset/dataset.h"
#include "model/importing/import.h"
#include "model/training/options.h"
#include "model/training/run.h"
#include "tests/importing/bvh_people.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"
#include "tests/training/made_up_dataset.h"

namespace duet::training {
namespace {

using test::TemporaryFolder;

using Replacements = std::vector<std::pair<std::string, std::string>>;

class OwnDataTest : public ::testing::Test {
 protected:
  // Two classes of two pairs, 20 joints.
  void SetUp() override {
    importing::WriteBvhPairs(folder_ / "captures", 2);
    importing::ImportOptions options;
    options.from = folder_ / "captures";
    options.out = folder_ / "studio";
    options.to_rate_hz = 15;
    options.touches = {"shove"};
    importing::ImportReport report;
    ASSERT_THAT(importing::Import(options, &report), IsOk());
    absl::StatusOr<dataset::Dataset> dataset = dataset::ReadDataset(options.out);
    ASSERT_THAT(dataset, IsOk());
    dataset_ = *std::move(dataset);
  }

  // Trains a small version of a named configuration and synthesises each sequence's follower.
  void TrainAndAsk(const std::string& config, const Replacements& smaller) {
    const absl::StatusOr<TrainingOptions> options = ParseConfig(FindConfig(config)->json, smaller);
    ASSERT_THAT(options, IsOk());
    RunPlan plan;
    plan.options = *options;
    plan.model_name = dataset_.name;
    plan.folder = folder_ / config;
    plan.train = AllOf(dataset_);
    std::ostringstream progress;
    ASSERT_THAT(RunTraining(plan, dataset_, false, &progress), IsOk());
    const auto model = cpu_engine::LoadCpuSynthesizer(CheckpointFolder(plan));
    ASSERT_THAT(model, IsOk());
    EXPECT_EQ((*model)->description().name, "studio");
    EXPECT_THAT((*model)->description().classes, ElementsAre("kick", "shove"));
    EXPECT_THAT((*model)->description().touching_classes, ElementsAre("shove"));
    for (const dataset::Sequence& sequence : dataset_.sequences) Ask(**model, sequence);
  }

  void Ask(const engine::Synthesizer& model, const dataset::Sequence& sequence) {
    engine::SynthesisWindow window;
    window.leader = sequence.pair.leader.poses;
    const int frames = window.leader.frame_count();
    for (int t = 0; t < frames; ++t) {
      for (int c = 0; c < dataset_.class_count(); ++c) {
        window.labels.push_back(c == sequence.interaction_class ? 1 : 0);
      }
    }
    const engine::SynthesisWindow* const windows[] = {&window};
    const std::vector<engine::WindowResult> results = model.Synthesize(windows);
    ASSERT_EQ(results.size(), 1u);
    ASSERT_THAT(results[0], IsOk());
    EXPECT_EQ(results[0]->frame_count(), frames);
    EXPECT_EQ(results[0]->joint_count(), 20);
    // A person of the leader's size on the leader's floor.
    const int head = dataset_.skeleton.Find("head");
    EXPECT_GT(results[0]->at(frames - 1, head).y, 1);
    EXPECT_LT(results[0]->at(frames - 1, head).y, 2);
  }

  TemporaryFolder folder_;
  dataset::Dataset dataset_;
};

TEST_F(OwnDataTest, SamplingConfigurationTrainsOnOwnData) {
  TrainAndAsk("flow", {{"epochs", "2"},
                       {"flow.passes", "1"},
                       {"flow.least_steps", "0"},
                       {"critic.steps", "4"},
                       {"generator.width", "8"},
                       {"generator.blocks", "1"},
                       {"generator.heads", "2"},
                       {"generator.feed_forward", "8"},
                       {"generator.reach", "8"}});
}

}  // namespace
}  // namespace duet::training

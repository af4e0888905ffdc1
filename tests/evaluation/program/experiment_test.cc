#include "model/evaluation/program/experiment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "tests/evaluation/support/made_up_pairs.h"
#include "tests/support/fake_synthesizer.h"
#include "tests/support/matchers.h"

namespace duet::evaluation::program {
namespace {

using test::MadeUpPairs;

// Stands still at a height that is the window's seed and at a distance that is its variety.
class SeedTeller : public engine::Synthesizer {
 public:
  explicit SeedTeller(const dataset::Dataset& dataset) {
    description_ = test::FakeDescription();
    description_.classes = dataset.classes;
    description_.samples = true;
  }

  const engine::ModelDescription& description() const override { return description_; }
  engine::ModelDescription& description() { return description_; }

  std::vector<engine::WindowResult> Synthesize(
      absl::Span<const engine::SynthesisWindow* const> windows) const override {
    std::vector<engine::WindowResult> results;
    for (const engine::SynthesisWindow* window : windows) {
      motion::Poses follower = window->leader;
      for (motion::Vec3& p : follower.all()) {
        p = {0, static_cast<float>(window->options.sampling.seed),
             window->options.sampling.variety};
      }
      results.emplace_back(std::move(follower));
    }
    return results;
  }

 private:
  engine::ModelDescription description_;
};

TEST(SampledAnswersTest, EveryAnswerHasASeedOfItsOwn) {
  const dataset::Dataset dataset = MadeUpPairs(3);
  const SeedTeller model(dataset);
  const auto answers = AnswerWithSamples(model, dataset, {4, 1}, {"none", 5, 0.5f, 7});
  ASSERT_TRUE(answers.ok()) << answers.status();
  ASSERT_THAT(*answers, SizeIs(5));
  std::set<float> seeds;
  for (const auto& set : *answers) {
    ASSERT_THAT(set, SizeIs(2));
    EXPECT_EQ(set[0].sequence, 4);
    EXPECT_EQ(set[1].sequence, 1);
    for (const metrics::ScoredMotion& motion : set) {
      EXPECT_EQ(motion.follower.at(0, 0).z, 0.5f);
      seeds.insert(motion.follower.at(0, 0).y);
    }
  }
  EXPECT_THAT(seeds, SizeIs(10));
}

TEST(SampledAnswersTest, AModelThatDoesNotSampleAnswersOnce) {
  const dataset::Dataset dataset = MadeUpPairs(1);
  SeedTeller model(dataset);
  model.description().samples = false;
  const auto answers = AnswerWithSamples(model, dataset, {0, 1}, {"none", 3});
  ASSERT_TRUE(answers.ok()) << answers.status();
  EXPECT_THAT(*answers, SizeIs(1));
}

TEST(SampledAnswersTest, UnsupportedStartIsRejected) {
  const dataset::Dataset dataset = MadeUpPairs(1);
  SeedTeller model(dataset);
  model.description().accepts_follower_start = false;
  EXPECT_THAT(AnswerWithSamples(model, dataset, {0}, {"pose"}).status(),
              StatusIs(absl::StatusCode::kFailedPrecondition, HasSubstr("follower start")));
}

using test::FakeAnswer;
using test::FakeSynthesizer;

// A leader that takes several windows of the model's.
dataset::Sequence Repeated(const dataset::Sequence& sequence, int times) {
  dataset::Sequence longer = sequence;
  for (int i = 1; i < times; ++i) {
    longer.pair.leader.Append(sequence.pair.leader.poses.all());
  }
  return longer;
}

TEST(SynthesizeSequences, AnswersClipsOfAnyLengthTogether) {
  const dataset::Dataset dataset = MadeUpPairs(2);
  const dataset::Sequence longer =
      Repeated(dataset.sequences[1], 4);  // 68 frames: two windows of 46
  std::vector<size_t> batches;
  FakeSynthesizer model;
  model.on_batch = [&](auto windows) { batches.push_back(windows.size()); };
  const std::vector<const dataset::Sequence*> sequences = {&dataset.sequences[0], &longer,
                                                           &dataset.sequences[0]};
  const std::vector<std::vector<float>> labels = {
      {1, 0, 0, 0, 0, 0}, {0, 0.5f, 0, 0, 0, 0}, {0, 0, 0, 0, 0, -1}};
  std::vector<LabelledLeader> leaders;
  for (size_t i = 0; i < labels.size(); ++i) {
    leaders.push_back({sequences[i], labels[i]});
  }
  const auto followers = SynthesizeSequences(model, leaders, {});
  ASSERT_TRUE(followers.ok()) << followers.status();
  EXPECT_THAT(batches, ElementsAre(3, 1));
  ASSERT_THAT(*followers, SizeIs(3));
  for (size_t i = 0; i < leaders.size(); ++i) {
    const motion::Poses leader = leaders[i].sequence->pair.leader.poses;
    const motion::Poses& follower = (*followers)[i];
    ASSERT_EQ(follower.frame_count(), leader.frame_count());
    ASSERT_EQ(follower.joint_count(), leader.joint_count());
    for (size_t p = 0; p < leader.all().size(); ++p) {
      const motion::Vec3 wanted = FakeAnswer(leader.all()[p], labels[i]);
      ASSERT_NEAR(Norm(follower.all()[p] - wanted), 0, 1e-4) << i << ", " << p;
    }
  }
}

TEST(SynthesizeSequences, PassesAFailureOn) {
  const dataset::Dataset dataset = MadeUpPairs(2);
  FakeSynthesizer model;
  model.window_status = [](const engine::SynthesisWindow& window) {
    return window.labels[1] > 0 ? absl::InternalError("no") : absl::OkStatus();
  };
  const auto labels = [](float first, float second) {
    return std::vector<float>{first, second, 0, 0, 0, 0};
  };
  const std::vector<LabelledLeader> leaders = {{&dataset.sequences[0], labels(1, 0)},
                                               {&dataset.sequences[0], labels(0, 1)}};
  EXPECT_TRUE(absl::IsInternal(SynthesizeSequences(model, leaders, {}).status()));
  EXPECT_TRUE(SynthesizeSequences(model, {leaders.data(), 1}, {}).ok());
}

TEST(LeaveOut, DefaultsToEverySubject) {
  dataset::Dataset dataset = MadeUpPairs(3);
  const auto subjects = [&dataset](const std::vector<std::string>& asked) {
    std::vector<std::string> names;
    const absl::StatusOr<std::vector<Fold>> folds = LeaveOut(dataset, asked);
    for (const Fold& fold : *folds) names.push_back(fold.subject);
    return names;
  };
  EXPECT_THAT(subjects({"b"}), ElementsAre("b"));
  EXPECT_THAT(subjects({}), ElementsAre("a", "b", "c"));
  for (dataset::Sequence& sequence : dataset.sequences) sequence.subjects.clear();
  EXPECT_TRUE(absl::IsInvalidArgument(LeaveOut(dataset, {}).status()));
}

TEST(ParseRuns, TakesAFolderWithOrWithoutAName) {
  EXPECT_EQ(ParseRuns("ours=runs/x")->name, "ours");
  EXPECT_EQ(ParseRuns("ours=runs/x")->folder, "runs/x");
  EXPECT_EQ(ParseRuns("runs/default")->name, "default");
  EXPECT_EQ(ParseRuns("runs/default/")->name, "default");
  EXPECT_EQ(ParseRuns("runs/default/")->folder, "runs/default/");
  for (const char* bad : {"", "=runs", "ours="}) {
    const absl::Status status = ParseRuns(bad).status();
    EXPECT_TRUE(absl::IsInvalidArgument(status)) << bad << ": " << status;
    EXPECT_THAT(std::string(status.message()), HasSubstr("NAME=DIR"));
  }
}

TEST(RecordedCommandTest, HasPlaceholdersForFoldersAndOnlyFlagsThatWereGiven) {
  const struct {
    std::vector<std::string> words;
    const char* recorded;
  } kCases[] = {{{"--data", "/home/me/sbu", "--checkpoint", "/models/sbu/2"},
                 "--data FOLDER --checkpoint FOLDER"},
                {{"--runs", "ours=/a/b", "--data", "x", "--runs", "/a/theirs/"},
                 "--data FOLDER --runs ours=RUNS --runs RUNS"},
                {{"--subjects", "s01,s02", "--data", "x", "--as-served", "--seed", "7"},
                 "--data FOLDER --subjects s01,s02 --as-served --seed 7"}};
  for (const auto& c : kCases) {
    CLI::App app;
    CLI::App* command = app.add_subcommand("measure", "");
    ExperimentFlags flags;
    AddAnswersFlags(&flags, command);
    std::vector<std::string> words(c.words.rbegin(), c.words.rend());  // in reverse, for CLI11
    words.push_back("measure");
    app.parse(words);
    EXPECT_EQ(RecordedCommand(*command), std::string("duet-eval measure ") + c.recorded);
  }
}

}  // namespace
}  // namespace duet::evaluation::program

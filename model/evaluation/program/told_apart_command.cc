#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_format.h"
#include "model/base/statistics.h"
#include "model/base/status_macros.h"
#include "model/evaluation/program/experiment.h"
#include "model/evaluation/program/measures.h"
#include "model/motion/filter.h"

namespace duet::evaluation::program {
namespace {

struct ToldApartFlags : ExperimentFlags {
  std::vector<uint64_t> seeds = {1, 2, 3};
};

constexpr int kCaptured = 0, kSynthesised = 1;

// A data set of two classes: pairs with captured followers, and pairs with synthesised ones.
dataset::Dataset PairsToTell(const dataset::Dataset& dataset,
                             const std::vector<metrics::ScoredMotion>& answers) {
  dataset::Dataset pairs = dataset;
  pairs.classes = {"captured", "synthesised"};
  pairs.symmetric = pairs.handed = pairs.touches = {false, false};
  pairs.sequences.clear();
  for (const metrics::ScoredMotion& answer : answers) {
    dataset::Sequence sequence = SequenceOf(dataset, answer);
    motion::ClipPair& pair = sequence.pair;
    const double rate = pair.leader.frame_rate_hz;
    pair.leader.poses = motion::WithoutNoise(pair.leader.poses, rate);
    pair.follower.poses = motion::WithoutNoise(pair.follower.poses, rate);
    sequence.interaction_class = kCaptured;
    pairs.sequences.push_back(sequence);
    pair.follower.poses = motion::WithoutNoise(answer.follower, rate);
    sequence.interaction_class = kSynthesised;
    pairs.sequences.push_back(std::move(sequence));
  }
  return pairs;
}

// The accuracies of one model. Shapes: returns [classifier seeds][folds].
absl::StatusOr<std::vector<std::vector<double>>> Accuracies(const Experiment& experiment,
                                                            const FoldModel& model,
                                                            const std::vector<uint64_t>& seeds) {
  std::vector<std::vector<double>> accuracies(seeds.size());
  for (const Fold& fold : experiment.folds) {
    const dataset::Dataset& dataset = experiment.dataset;
    DUET_TRY(const SharedSynthesizer synthesizer, model.load(fold.subject));
    DUET_TRY(auto training,
             AnswerWithSamples(*synthesizer, dataset, fold.split.train, model.asked));
    DUET_TRY(auto test, AnswerWithSamples(*synthesizer, dataset, fold.split.test, model.asked));
    for (size_t i = 0; i < seeds.size(); ++i) {
      DUET_TRY(const double accuracy,
               ToldApart(dataset, training.front(), test.front(), ToldApartOptions(seeds[i])));
      std::cerr << absl::StrFormat("%s without %s, classifier %d: %.3f\n", model.name, fold.subject,
                                   seeds[i], accuracy);
      accuracies[i].push_back(accuracy);
    }
  }
  return accuracies;
}

absl::StatusOr<report::Section> RunToldApart(const ToldApartFlags& flags) {
  DUET_TRY(const Experiment experiment, OpenExperiment(flags));
  report::Section section = BeginExperiment(
      flags, experiment,
      "A fresh classifier that sees leader and follower learns to tell a fold's answers to its "
      "training leaders from the captured pairs of the same people, and is tested on the left-out "
      "person: on that fold's answers to leaders never seen, and on the captured pairs. Both sides "
      "go through the same Gaussian of 0.1 s, so that a capture's noise gives nothing away.");
  report::Table& table = section.tables.emplace_back();
  table.title = "Balanced accuracy of telling synthesised from captured pairs";
  for (const Fold& fold : experiment.folds) table.columns.push_back(fold.subject);
  table.columns.insert(table.columns.end(), {"mean", "spread"});
  table.decimals = 3;
  table.notes = {
      "0.5: cannot be told apart; 1: always. A column is a left-out person; spread: the standard "
      "deviation of the mean over the classifiers' seeds."};
  for (const FoldModel& model : experiment.models) {
    DUET_TRY(const auto accuracies, Accuracies(experiment, model, flags.seeds));
    std::vector<double> values = report::ColumnMeans(accuracies), means;
    for (const std::vector<double>& of_folds : accuracies) means.push_back(base::Mean(of_folds));
    const base::MeanAndDeviation of_seeds = base::Summarise(means);
    values.insert(values.end(), {of_seeds.mean, of_seeds.deviation});
    table.rows.push_back({model.name, std::move(values)});
  }
  return section;
}

}  // namespace

judge::MotionClassifierOptions ToldApartOptions(uint64_t seed) {
  judge::MotionClassifierOptions options;
  options.sees = judge::Sees::kBoth;
  options.body_noise = 0.01;
  options.seed = seed;
  return options;
}

absl::StatusOr<double> ToldApart(const dataset::Dataset& dataset,
                                 const std::vector<metrics::ScoredMotion>& training_answers,
                                 const std::vector<metrics::ScoredMotion>& test_answers,
                                 const judge::MotionClassifierOptions& options) {
  const dataset::Dataset training = PairsToTell(dataset, training_answers);
  DUET_TRY(
      const auto classifier,
      judge::MotionClassifier::Train(
          training, metrics::CapturedMotions(training, dataset::AllSequences(training)), options));
  const dataset::Dataset test = PairsToTell(dataset, test_answers);
  const metrics::JudgedFold judged =
      classifier.Judge(test, metrics::CapturedMotions(test, dataset::AllSequences(test)));
  return base::Mean(metrics::AccuracyByClass({judged}, test.class_count()));
}

Measure AddToldApartCommand(CLI::App* command) {
  const auto flags = std::make_shared<ToldApartFlags>();
  AddAnswersFlags(flags.get(), command);
  AddOption("--seeds", &flags->seeds, "seeds; one classifier per seed", command)->delimiter(',');
  return [flags] { return RunToldApart(*flags); };
}

}  // namespace duet::evaluation::program

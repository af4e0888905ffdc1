#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "model/base/status_macros.h"
#include "model/evaluation/baselines/baselines.h"
#include "model/evaluation/program/experiment.h"
#include "model/evaluation/report/metric_tables.h"
#include "model/motion/filter.h"

namespace duet::evaluation::program {
namespace {

using metrics::JudgedFold;
using metrics::SampledMotions;

FoldAnswers Filtered(const dataset::Dataset& dataset, FoldAnswers folds) {
  for (std::vector<metrics::ScoredMotion>& motions : folds) {
    for (metrics::ScoredMotion& motion : motions) {
      const double rate = SequenceOf(dataset, motion).pair.leader.frame_rate_hz;
      motion.follower = motion::WithoutNoise(motion.follower, rate);
    }
  }
  return folds;
}

// Adds values / count to sums, which may still be empty.
void AddShare(const std::vector<double>& values, size_t count, std::vector<double>* sums) {
  sums->resize(values.size());
  for (size_t i = 0; i < values.size(); ++i) (*sums)[i] += values[i] / static_cast<double>(count);
}

// Scores many answers to each leader of every fold.
class Scorer {
 public:
  // `experiment` must outlive the scorer.
  static absl::StatusOr<Scorer> Create(const Experiment& experiment) {
    Scorer scorer(experiment);
    const dataset::Dataset& dataset = experiment.dataset;
    const FoldAnswers captured = CapturedAnswers(experiment);
    DUET_TRY(scorer.judges_, TrainJudges(dataset, experiment.folds));
    scorer.captured_ = JudgeFolds(scorer.judges_, dataset, captured);
    scorer.filtered_ = JudgeFolds(scorer.judges_, dataset, Filtered(dataset, captured));
    return scorer;
  }

  // Shapes: sets [samples], answers to all leaders each.
  report::MethodFigures Score(const std::string& row, const std::vector<FoldAnswers>& sets) const {
    const dataset::Dataset& dataset = experiment_.dataset;
    const int classes = dataset.class_count();
    SampledMotions answers;
    for (const FoldAnswers& set : sets) answers.push_back(Pool(set));
    report::MethodFigures figures{row, false, ScoreByClass(dataset, Pool(answers))};
    auto& by_metric = figures.by_metric;
    by_metric[report::kMeanAnswerAfd] = ScoreByClass(dataset, MeanAnswers(answers))["afd"];
    by_metric[report::kBestAnswerAfd] = ScoreByClass(dataset, BestAnswers(dataset, answers))["afd"];
    by_metric[report::kMultimodality] = MultimodalityByClass(dataset, answers);
    for (const FoldAnswers& set : sets) {
      const std::vector<JudgedFold> made = JudgeFolds(judges_, dataset, set),
                                    filtered = JudgeFolds(judges_, dataset, Filtered(dataset, set));
      const auto add = [&](const char* name, const std::vector<double>& values) {
        AddShare(values, sets.size(), &by_metric[name]);
      };
      add(report::kPooledFrechet, {PooledFrechet(made, captured_)});
      add(report::kFilteredFrechet, {PooledFrechet(filtered, filtered_)});
      add(report::kAccuracy, AccuracyByClass(made, classes));
      add(report::kDiversity, DiversityByClass(made, classes));
      add(report::kFilteredDiversity, DiversityByClass(filtered, classes));
    }
    return figures;
  }

 private:
  explicit Scorer(const Experiment& experiment) : experiment_(experiment) {}

  const Experiment& experiment_;
  std::vector<judge::MotionClassifier> judges_;
  std::vector<JudgedFold> captured_, filtered_;  // of the captured followers
};

absl::StatusOr<report::Section> RunSamples(const ExperimentFlags& flags) {
  DUET_TRY(const Experiment experiment, OpenExperiment(flags));
  DUET_TRY(const Scorer scorer, Scorer::Create(experiment));
  std::vector<report::MethodFigures> rows = {
      scorer.Score("captured", {CapturedAnswers(experiment)})};
  std::vector<FoldAnswers> others(static_cast<size_t>(flags.asked.samples));
  for (size_t n = 0; n < others.size(); ++n) {
    for (const Fold& fold : experiment.folds) {
      DUET_TRY(others[n].emplace_back(), baselines::AnswerWithOtherPeople(
                                             experiment.dataset, fold.split, flags.asked.seed + n));
    }
  }
  rows.push_back(scorer.Score("other people", others));
  for (const std::string& start : flags.starts) {
    for (const FoldModel& model : experiment.models) {
      Asked asked = flags.asked;
      asked.start = start;
      DUET_TRY(const std::vector<FoldAnswers> sets, AnswerFolds(experiment, model, asked));
      rows.push_back(scorer.Score(model.name + StartSuffix(start), sets));
    }
  }
  report::Section section = BeginExperiment(
      flags, experiment,
      "A model that samples answers every leader of every left-out subject several times, each "
      "time with another seed; other models answer once. The average frame distance rewards the "
      "mean of all plausible motions, so the table gives it for one answer, for the mean of all "
      "answers and for the best. Speed, range, diversity and lean should be close to the captured "
      "followers' row, neither below nor above it. +pose: the input includes the follower's first "
      "pose. Other people: captured followers of training clips of the same class, drawn at "
      "random, who answered another leader.");
  section.tables = {report::SampleSummary(rows)};
  return section;
}

}  // namespace

Measure AddSamplesCommand(CLI::App* command) {
  const auto flags = std::make_shared<ExperimentFlags>();
  flags->asked.samples = 10;
  AddAnswersFlags(flags.get(), command);
  return [flags] { return RunSamples(*flags); };
}

}  // namespace duet::evaluation::program

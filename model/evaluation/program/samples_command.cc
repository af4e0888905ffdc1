#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "model/base/status_macros.h"
#include "model/evaluation/baselines/baselines.h"
#include "model/evaluation/program/commands.h"
#include "model/evaluation/program/experiment.h"
#include "model/evaluation/program/fold_scorer.h"
#include "model/evaluation/report/metric_tables.h"
#include "model/evaluation/report/result_section.h"

namespace duet::evaluation::program {
namespace {

absl::StatusOr<report::MethodFigures> ScoreModel(const dataset::Dataset& dataset,
                                                 const FoldScorer& scorer, const FoldModel& model,
                                                 const std::string& start,
                                                 const experiments::AskedSamples& asked) {
  const std::string row = model.name + StartSuffix(ParseStart(start));
  std::vector<metrics::SampledMotions> answers;
  for (const Fold& fold : scorer.folds()) {
    DUET_TRY(answers.emplace_back(), Answers(dataset, model, fold, fold.split.test, start, asked));
    std::cerr << absl::StrCat(row, " without ", fold.subject, ": ", fold.split.test.size(),
                              " leaders, ", answers.back().size(), " answers each\n");
  }
  return scorer.ScoreSamples(row, answers);
}

// The same figures for captured people who answer another leader of the class.
absl::StatusOr<report::MethodFigures> ScoreOtherPeople(const dataset::Dataset& dataset,
                                                       const FoldScorer& scorer,
                                                       const experiments::AskedSamples& asked) {
  std::vector<metrics::SampledMotions> answers;
  for (const Fold& fold : scorer.folds()) {
    metrics::SampledMotions of_fold(static_cast<size_t>(asked.samples));
    for (size_t n = 0; n < of_fold.size(); ++n) {
      DUET_TRY(std::vector<motion::Poses> followers,
               baselines::AnswerWithOtherPeople(dataset, fold.split.train, fold.split.test,
                                                asked.seed + n));
      auto follower = followers.begin();
      for (const int index : fold.split.test) {
        of_fold[n].push_back({index, std::move(*follower++)});
      }
    }
    answers.push_back(std::move(of_fold));
  }
  return scorer.ScoreSamples("other people", answers);
}

absl::StatusOr<std::vector<report::MethodFigures>> Rows(const Experiment& experiment,
                                                        const FoldScorer& scorer,
                                                        const ExperimentFlags& flags) {
  std::vector<report::MethodFigures> rows;
  DUET_TRY(rows.emplace_back(), scorer.ScoreCapturedSamples());
  DUET_TRY(rows.emplace_back(), ScoreOtherPeople(experiment.dataset, scorer, flags.asked));
  for (const std::string& start : flags.starts) {
    for (const FoldModel& model : experiment.models) {
      DUET_TRY(rows.emplace_back(),
               ScoreModel(experiment.dataset, scorer, model, start, flags.asked));
    }
  }
  return rows;
}

absl::Status RunSamples(const ExperimentFlags& flags) {
  DUET_TRY(Experiment experiment, OpenExperiment(flags));
  DUET_TRY(FoldScorer scorer, FoldScorer::Create(experiment.dataset, experiment.folds,
                                                 FoldScorer::Judging::kFiltered));
  DUET_TRY(std::vector<report::MethodFigures> rows, Rows(experiment, scorer, flags));
  report::ResultSection section = BeginAnswers(
      flags, experiment,
      "A model that samples answers every leader of every left-out subject several times, each "
      "time with another seed; other models answer once. The average frame distance rewards the "
      "mean of all plausible motions, so the table gives it for one answer, for the mean of all "
      "answers and for the best. Speed, range, diversity and lean should be close to the captured "
      "followers' row, neither below nor above it. +pose: the input includes the follower's first "
      "pose. Other people: captured followers of training clips of the same class, drawn at "
      "random, who answered another leader.");
  section.settings.emplace_back("answers to a leader", absl::StrCat(flags.asked.samples));
  section.settings.emplace_back("direction of the partner",
                                flags.asked.tell_direction ? "in the request" : "from the leader");
  for (auto& setting : scorer.JudgeSettings()) section.settings.push_back(std::move(setting));
  section.tables = {report::SampleSummary(rows)};
  for (report::Table& table : report::SampleTables(experiment.dataset.classes, rows)) {
    section.tables.push_back(std::move(table));
  }
  return FinishSection(flags.section, section);
}

}  // namespace

void AddSamplesCommand(CLI::App* app, ChosenCommand* chosen) {
  const auto [flags, command] =
      AddCommand("samples", "Figures of many answers to each leader", RunSamples, app, chosen);
  AddAnswersFlags("14_samples", "Many answers to one leader", flags, command);
  AddNumber("--samples", &flags->asked.samples, 1, 1000,
            "answers to each leader by a model that samples", command);
  command->add_flag("!--untold-direction", flags->asked.tell_direction,
                    "estimate the partner's direction from the leader's motion");
}

}  // namespace duet::evaluation::program

#include <cstddef>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/base/status_macros.h"
#include "model/evaluation/experiments/label_sweep.h"
#include "model/evaluation/program/commands.h"
#include "model/evaluation/program/experiment.h"
#include "model/evaluation/program/fold_scorer.h"

namespace duet::evaluation::program {
namespace {

struct SweepArguments : ExperimentFlags {
  std::vector<uint64_t> sample_seeds = {0};
};

// A fold with its generator and its judge. Neither has seen the left-out subject.
struct SweepFold {
  const Fold* fold;
  SharedSynthesizer model;
  judge::MotionClassifier judge;
};

// A leader's answers at every weight of every class, own and added: all with one seed, so that only
// the weight differs.
absl::Status SweepLeader(const dataset::Dataset& dataset, const SweepFold& fold, int index,
                         experiments::StartGiven start, const engine::Sampling& sampling,
                         std::vector<experiments::SweepCurve>* curves) {
  const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(index)];
  const int classes = dataset.class_count(), own = sequence.interaction_class;
  std::vector<experiments::LabelledLeader> leaders;
  for (int raised = 0; raised < classes; ++raised) {
    for (const double weight : experiments::SweepWeights()) {
      std::vector<float> labels = experiments::OneClass(classes, own);
      labels[static_cast<size_t>(raised)] = static_cast<float>(weight);
      leaders.push_back({&sequence, engine::LabelTrack(labels), sampling});
    }
  }
  DUET_TRY(std::vector<motion::Poses> followers, SynthesizeSequences(*fold.model, leaders, start));
  std::vector<metrics::ScoredMotion> motions;
  for (motion::Poses& follower : followers) motions.push_back({index, std::move(follower)});
  const auto probabilities = fold.judge.Probabilities(dataset, motions);
  auto row = probabilities.begin();
  for (int raised = 0; raised < classes; ++raised) {
    const auto end = row + static_cast<std::ptrdiff_t>(experiments::SweepWeights().size());
    curves->push_back({own, raised, {row, end}});
    row = end;
  }
  return absl::OkStatus();
}

absl::StatusOr<SweepFold> OpenFold(const dataset::Dataset& dataset, const FoldModel& model,
                                   const Fold& fold, const std::vector<std::string>& starts) {
  DUET_TRY(SharedSynthesizer synthesizer, model.load(fold.subject));
  for (const std::string& start : starts) {
    DUET_RETURN_IF_ERROR(CheckModelTakes(synthesizer->description(), dataset, ParseStart(start)));
  }
  DUET_TRY(judge::MotionClassifier judge, TrainFoldJudge(dataset, fold));
  return SweepFold{&fold, std::move(synthesizer), std::move(judge)};
}

absl::StatusOr<std::vector<experiments::SweepCurve>> SweepFolds(const dataset::Dataset& dataset,
                                                                const std::vector<SweepFold>& folds,
                                                                experiments::StartGiven start,
                                                                const SweepArguments& arguments) {
  std::vector<experiments::SweepCurve> curves;
  for (const SweepFold& fold : folds) {
    // A model that does not sample has the same answer for every seed.
    const size_t seeds =
        fold.model->description().samples ? arguments.sample_seeds.size() : size_t{1};
    for (const int index : fold.fold->split.test) {
      for (size_t i = 0; i < seeds; ++i) {
        const engine::Sampling sampling = {arguments.sample_seeds[i], arguments.asked.variety};
        DUET_RETURN_IF_ERROR(SweepLeader(dataset, fold, index, start, sampling, &curves));
      }
    }
    std::cerr << "sweep" << StartSuffix(start) << " without " << fold.fold->subject << ": "
              << fold.fold->split.test.size() << " leaders\n";
  }
  return curves;
}

const char* Told(experiments::StartGiven start) {
  if (start == experiments::StartGiven::kNone) return "without a start";
  return start == experiments::StartGiven::kRoot ? "given the first root" : "given the first pose";
}

absl::Status RunSweep(const SweepArguments& arguments) {
  DUET_TRY(Experiment experiment, OpenExperiment(arguments));
  const dataset::Dataset& dataset = experiment.dataset;
  std::vector<SweepFold> folds;
  for (const Fold& fold : experiment.folds) {
    DUET_TRY(SweepFold opened,
             OpenFold(dataset, experiment.models.front(), fold, arguments.starts));
    folds.push_back(std::move(opened));
  }
  report::ResultSection section = BeginExperiment(
      arguments, experiment,
      "Every leader of every fold's left-out subject is answered at each weight from -1 to 2 of "
      "its own class alone, and of each other class beside its own at 1. The fold's judge, trained "
      "without the left-out subject, gives the probability of each class. At weight 0 of its own "
      "class, the network has no label and infers the motion from the leader.");
  section.settings.emplace_back("model", experiment.models.front().name);
  section.settings.emplace_back("seeds of a model that samples",
                                absl::StrJoin(arguments.sample_seeds, ", "));
  section.settings.emplace_back("variety", absl::StrCat(arguments.asked.variety));
  for (const SweepFold& fold : folds) {
    section.settings.push_back(JudgeSetting(*fold.fold, fold.judge));
  }
  for (const std::string& name : arguments.starts) {
    const experiments::StartGiven start = ParseStart(name);
    DUET_TRY(auto curves, SweepFolds(dataset, folds, start, arguments));
    experiments::AddSweep(dataset.classes, curves, Told(start), &section);
  }
  return FinishSection(arguments.section, section);
}

}  // namespace

void AddSweepCommand(CLI::App* app, ChosenCommand* chosen) {
  const auto [arguments, command] =
      AddCommand("sweep", "Effect of raising and lowering label weights", RunSweep, app, chosen);
  AddExperimentFlags("30_sweep", "Mix, match and avoid: what label weights do", arguments, command);
  arguments->models.runs.resize(1);
  command
      ->add_option("--runs", arguments->models.runs.front(), "output of duet-train --protocol loso")
      ->type_name(kNamedRuns)
      ->required();
  AddAsServedFlag(&arguments->models, command);
  AddStartsFlag(&arguments->starts, command);
  AddOption("--sample-seeds", &arguments->sample_seeds,
            "seeds of a model that samples; each leader is swept with every seed", command)
      ->delimiter(',');
  AddNumber("--variety", &arguments->asked.variety, 0.0, 2.0, kVarietyHelp, command);
}

}  // namespace duet::evaluation::program

#include "model/evaluation/program/experiment.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/evaluation/program/model_flags.h"

namespace duet::evaluation::program {

void AddExperimentFlags(const std::string& id, const std::string& title, ExperimentFlags* flags,
                        CLI::App* command) {
  flags->section.id = id;
  flags->section.title = title;
  AddDataFlag(&flags->data, command);
  AddSubjectsFlag(&flags->subjects, command);
  AddSectionFlags(&flags->section, command);
}

void AddAnswersFlags(const std::string& id, const std::string& title, ExperimentFlags* flags,
                     CLI::App* command) {
  AddExperimentFlags(id, title, flags, command);
  AddModelFlags(ModelNeeded::kYes, &flags->models, command);
  AddStartsFlag(&flags->starts, command);
  AddSamplingFlags(&flags->asked, command);
}

absl::StatusOr<std::vector<Fold>> LeaveOut(const dataset::Dataset& dataset,
                                           const std::vector<std::string>& asked) {
  std::vector<Fold> folds;
  for (const std::string& subject : asked.empty() ? dataset.Subjects() : asked) {
    absl::StatusOr<dataset::Split> split = LeaveSubjectOut(dataset, subject);
    if (!split.ok()) return split.status();
    folds.push_back({subject, *std::move(split)});
  }
  if (!folds.empty()) return folds;
  return absl::InvalidArgumentError(
      absl::StrCat(dataset.name, ": expected sequences that name their subjects, got none"));
}

absl::StatusOr<Experiment> OpenExperiment(const ExperimentFlags& flags) {
  absl::StatusOr<dataset::Dataset> dataset = dataset::ReadDataset(flags.data);
  if (!dataset.ok()) return dataset.status();
  absl::StatusOr<std::vector<Fold>> folds = LeaveOut(*dataset, flags.subjects);
  if (!folds.ok()) return folds.status();
  absl::StatusOr<std::vector<FoldModel>> models = OpenModels(flags.models);
  if (!models.ok()) return models.status();
  return Experiment{*std::move(dataset), *std::move(folds), *std::move(models)};
}

absl::StatusOr<metrics::SampledMotions> Answers(const dataset::Dataset& dataset,
                                                const FoldModel& model, const Fold& fold,
                                                const std::vector<int>& sequences,
                                                const std::string& start,
                                                const experiments::AskedSamples& asked) {
  absl::StatusOr<SharedSynthesizer> synthesizer = model.load(fold.subject);
  if (!synthesizer.ok()) return synthesizer.status();
  return AnswerWithSamples(**synthesizer, dataset, sequences, ParseStart(start), asked);
}

report::ResultSection BeginExperiment(const ExperimentFlags& flags, const Experiment& experiment,
                                      const std::string& text) {
  report::ResultSection section = BeginSection(flags.section, text);
  if (flags.models.one_for_all()) section.text.push_back(kOneForAll);
  std::vector<std::string> subjects;
  for (const Fold& fold : experiment.folds) subjects.push_back(fold.subject);
  section.settings = {
      {"data", DescribeData(experiment.dataset)},
      {"left out in turn", absl::StrJoin(subjects, ", ")},
      {"models' answers", flags.models.as_served ? "as served" : "the network's own"}};
  return section;
}

report::ResultSection BeginAnswers(const ExperimentFlags& flags, const Experiment& experiment,
                                   const std::string& text) {
  report::ResultSection section = BeginExperiment(flags, experiment, text);
  AddSamplingSettings(flags.asked, &section);
  return section;
}

}  // namespace duet::evaluation::program

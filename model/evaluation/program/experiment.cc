#include "model/evaluation/program/experiment.h"

#include <iostream>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/evaluation/program/fold_judge.h"
#include "model/evaluation/program/model_flags.h"

namespace duet::evaluation::program {

void AddExperimentFlags(ExperimentFlags* flags, CLI::App* command) {
  command->add_option("--data", flags->data, "folder of captures (docs/datasets.md)")->required();
  command->add_option("--subjects", flags->subjects, "folds; default: every subject")
      ->delimiter(',');
  command->add_option("--out", flags->out, "folder of results, for duet-eval report");
  command->add_option("--id", flags->id, "of the section")->capture_default_str();
  command->add_option("--title", flags->title, "of the section")->capture_default_str();
}

absl::StatusOr<Experiment> OpenExperiment(const ExperimentFlags& flags) {
  absl::StatusOr<dataset::Dataset> dataset = dataset::ReadDataset(flags.data);
  if (!dataset.ok()) return dataset.status();
  absl::StatusOr<std::vector<std::string>> subjects = FoldSubjects(*dataset, flags.subjects);
  if (!subjects.ok()) return subjects.status();
  absl::StatusOr<std::vector<FoldModel>> models = OpenModels(flags.models);
  if (!models.ok()) return models.status();
  return Experiment{*std::move(dataset), *std::move(subjects), *std::move(models)};
}

report::ResultSection BeginSection(const ExperimentFlags& flags, const Experiment& experiment,
                                   const std::string& text) {
  const dataset::Dataset& dataset = experiment.dataset;
  report::ResultSection section;
  section.id = flags.id;
  section.title = flags.title;
  section.text = {text};
  if (flags.models.one_for_all()) section.text.push_back(kOneForAll);
  section.settings = {
      {"data", absl::StrCat(dataset.name, ", ", dataset.sequences.size(), " sequences")},
      {"left out in turn", absl::StrJoin(experiment.subjects, ", ")},
      {"models' answers", flags.models.as_served ? "as served" : "the network's own"}};
  section.date = report::Today();
  return section;
}

absl::Status FinishSection(const ExperimentFlags& flags, const report::ResultSection& section) {
  for (const report::Table& table : section.tables) std::cout << ToPlainText(table) << "\n";
  return flags.out.empty() ? absl::OkStatus() : WriteSection(section, flags.out);
}

}  // namespace duet::evaluation::program

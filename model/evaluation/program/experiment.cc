#include "model/evaluation/program/experiment.h"

#include <utility>

#include "absl/strings/str_join.h"
#include "model/evaluation/program/fold_judge.h"
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

absl::StatusOr<Experiment> OpenExperiment(const ExperimentFlags& flags) {
  absl::StatusOr<dataset::Dataset> dataset = dataset::ReadDataset(flags.data);
  if (!dataset.ok()) return dataset.status();
  absl::StatusOr<std::vector<std::string>> subjects = FoldSubjects(*dataset, flags.subjects);
  if (!subjects.ok()) return subjects.status();
  absl::StatusOr<std::vector<FoldModel>> models = OpenModels(flags.models);
  if (!models.ok()) return models.status();
  return Experiment{*std::move(dataset), *std::move(subjects), *std::move(models)};
}

report::ResultSection BeginExperiment(const ExperimentFlags& flags, const Experiment& experiment,
                                      const std::string& text) {
  report::ResultSection section = BeginSection(flags.section, text);
  if (flags.models.one_for_all()) section.text.push_back(kOneForAll);
  section.settings = {
      {"data", DescribeData(experiment.dataset)},
      {"left out in turn", absl::StrJoin(experiment.subjects, ", ")},
      {"models' answers", flags.models.as_served ? "as served" : "the network's own"}};
  return section;
}

}  // namespace duet::evaluation::program

#include "model/evaluation/program/experiment.h"

#include <system_error>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/base/status_macros.h"
#include "model/base/text.h"
#include "model/evaluation/program/flags.h"
#include "model/torch_engine/torch_synthesizer.h"

namespace duet::evaluation::program {
namespace {

namespace fs = std::filesystem;

absl::StatusOr<SharedSynthesizer> LoadOne(const ModelChoice& choice) {
  const engine::PipelineOptions options{choice.as_served, choice.as_served, choice.as_served};
  if (!choice.embedded) return torch_engine::LoadTorchSynthesizer(choice.checkpoint, options);
  DUET_TRY(auto all, torch_engine::LoadEmbeddedSynthesizers(options));
  return SharedSynthesizer(std::move(all.front()));
}

}  // namespace

absl::StatusOr<NamedRuns> ParseRuns(const std::string& text) {
  const size_t equals = text.find('=');
  NamedRuns runs{text.substr(0, equals), text};
  if (equals == std::string::npos) {
    // "runs/" ends in an empty part.
    const fs::path path = (fs::path(text) / "").parent_path();
    runs.name = path.lexically_normal().filename().string();
  } else {
    runs.folder = text.substr(equals + 1);
  }
  if (!runs.name.empty() && !runs.folder.empty()) return runs;
  return absl::InvalidArgumentError(
      absl::StrCat("--runs: expected NAME=DIR or DIR, got ", base::Quoted(text)));
}

absl::StatusOr<checkpoint::Checkpoint> ReadRunCheckpoint(const fs::path& run) {
  std::vector<fs::path> found;
  std::error_code error;
  for (const auto& name : fs::directory_iterator(run / "checkpoint", error)) {
    for (const auto& version : fs::directory_iterator(name.path(), error)) {
      // A dot marks an unfinished write of an interrupted run.
      if (version.path().filename().string().front() != '.') found.push_back(version.path());
    }
  }
  if (found.size() == 1) return checkpoint::ReadCheckpoint(found[0]);
  return absl::NotFoundError(absl::StrCat(run.string(),
                                          ": expected one finished run of duet-train, got ",
                                          found.size(), " checkpoints"));
}

absl::StatusOr<SharedSynthesizer> LoadFoldModel(const fs::path& runs, const std::string& subject,
                                                bool as_served) {
  DUET_TRY(checkpoint::Checkpoint checkpoint, ReadRunCheckpoint(runs / subject));
  return torch_engine::MakeTorchSynthesizer(checkpoint, {as_served, as_served, as_served});
}

absl::StatusOr<std::vector<FoldModel>> OpenModels(const ModelChoice& choice) {
  std::vector<FoldModel> models;
  if (choice.one_for_all()) {
    DUET_TRY(SharedSynthesizer one, LoadOne(choice));
    models.push_back({"duet", [one](const std::string&) { return one; }});
  }
  for (const std::string& text : choice.runs) {
    DUET_TRY(NamedRuns runs, ParseRuns(text));
    models.push_back(
        {runs.name, [runs = runs, as_served = choice.as_served](const std::string& subject) {
           return LoadFoldModel(runs.folder, subject, as_served);
         }});
  }
  return models;
}

void AddExperimentFlags(const std::string& id, const std::string& title, ExperimentFlags* flags,
                        CLI::App* command) {
  flags->section.id = id;
  flags->section.title = title;
  AddDataFlag(&flags->data, command);
  command
      ->add_option("--subjects", flags->subjects,
                   "subjects to leave out, one at a time (default: every subject)")
      ->delimiter(',');
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
    DUET_TRY(dataset::Split split, LeaveSubjectOut(dataset, subject));
    folds.push_back({subject, std::move(split)});
  }
  if (!folds.empty()) return folds;
  return LeaveSubjectOut(dataset, "").status();  // says that there is nobody
}

absl::StatusOr<Experiment> OpenExperiment(const ExperimentFlags& flags) {
  DUET_TRY(dataset::Dataset dataset, dataset::ReadDataset(flags.data));
  DUET_TRY(std::vector<Fold> folds, LeaveOut(dataset, flags.subjects));
  DUET_TRY(std::vector<FoldModel> models, OpenModels(flags.models));
  return Experiment{std::move(dataset), std::move(folds), std::move(models)};
}

absl::StatusOr<metrics::SampledMotions> Answers(const dataset::Dataset& dataset,
                                                const FoldModel& model, const Fold& fold,
                                                const std::vector<int>& sequences,
                                                const std::string& start,
                                                const experiments::AskedSamples& asked) {
  DUET_TRY(SharedSynthesizer synthesizer, model.load(fold.subject));
  return AnswerWithSamples(*synthesizer, dataset, sequences, ParseStart(start), asked);
}

report::ResultSection BeginExperiment(const ExperimentFlags& flags, const Experiment& experiment,
                                      const std::string& text) {
  report::ResultSection section = BeginSection(flags.section, text);
  if (flags.models.one_for_all()) {
    section.text.push_back(
        "One checkpoint for every fold: it may have been trained on what is tested.");
  }
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

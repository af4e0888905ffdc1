#include <filesystem>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/base/status_macros.h"
#include "model/dataset/dataset.h"
#include "model/evaluation/experiments/latent.h"
#include "model/evaluation/metrics/judged_scores.h"
#include "model/evaluation/metrics/scores.h"
#include "model/evaluation/program/commands.h"
#include "model/evaluation/program/experiment.h"
#include "model/evaluation/program/flags.h"

namespace duet::evaluation::program {
namespace {

// The columns of the table: how many nearest neighbours vote on a clip's class.
constexpr int kNeighbours[] = {1, 5};

struct LatentArguments {
  std::string data;
  std::vector<std::string> runs;
  std::vector<std::string> subjects;
  std::string clips = "test";
  double perplexity = 30;
  uint64_t seed = 1;
  SectionFlags section = {"50_latent", "Latent space (Figures 6 and 7)"};
};

// The clips of a fold to show.
absl::StatusOr<std::vector<int>> ChooseClips(const dataset::Dataset& dataset,
                                             const std::string& subject, const std::string& which) {
  DUET_TRY(dataset::Split split, LeaveSubjectOut(dataset, subject));
  if (which == "test") return split.test;
  if (which == "train") return split.train;
  split.test.insert(split.test.end(), split.train.begin(), split.train.end());
  return split.test;
}

std::string FigureName(std::string text) {
  for (char& c : text) {
    const auto byte = static_cast<unsigned char>(c);
    c = absl::ascii_isalnum(byte) ? absl::ascii_tolower(byte) : '_';
  }
  return text;
}

// A model of one fold.
struct FoldCheckpoint {
  std::string model;
  std::string subject;
  checkpoint::Checkpoint checkpoint;
};

// Measures one latent space: a figure and a row of the table.
absl::Status AddSpace(const dataset::Dataset& dataset, const FoldCheckpoint& fold,
                      experiments::LatentLabels labels, const LatentArguments& arguments,
                      report::ResultSection* section) {
  DUET_TRY(std::vector<int> clips, ChooseClips(dataset, fold.subject, arguments.clips));
  DUET_TRY(metrics::FeatureSet features, LatentFeatures(fold.checkpoint, dataset, clips, labels));
  const std::vector<int> classes = metrics::ClassesOf(dataset, clips);
  const bool blind = labels == experiments::LatentLabels::kNone;
  const std::string name =
      absl::StrCat(fold.model, blind ? ", label withheld" : "", ", ", fold.subject);
  report::TableRow row{name, {}};
  for (const int count : kNeighbours) {
    DUET_TRY(row.values.emplace_back(), metrics::NeighbourAccuracy(features, classes, count));
  }
  section->tables.front().rows.push_back(std::move(row));
  section->figures.push_back(
      {FigureName(
           absl::StrCat(section->id, "_", fold.model, blind ? "_no_label_" : "_", fold.subject)),
       absl::StrCat("Latent space of ", fold.model, " with ", fold.subject, " left out",
                    blind ? ", the label vector withheld" : "", ": t-SNE of ", clips.size(),
                    " clips, one point each."),
       report::LatentPlot{name, dataset.classes, classes, std::move(features), arguments.perplexity,
                          arguments.seed}});
  return absl::OkStatus();
}

// A model that reads labels is measured a second time without the label, which by itself separates
// the classes.
absl::Status AddModel(const dataset::Dataset& dataset, const NamedRuns& runs,
                      const std::vector<std::string>& subjects, const LatentArguments& arguments,
                      report::ResultSection* section) {
  std::error_code error;
  // Of duet-train --protocol loso, a run for each fold; otherwise a single one.
  const bool is_run = std::filesystem::exists(runs.folder / "checkpoint", error);
  for (const std::string& subject : subjects) {
    DUET_TRY(checkpoint::Checkpoint checkpoint,
             ReadRunCheckpoint(is_run ? runs.folder : runs.folder / subject));
    const FoldCheckpoint fold = {runs.name, subject, std::move(checkpoint)};
    DUET_RETURN_IF_ERROR(
        AddSpace(dataset, fold, experiments::LatentLabels::kOwnClass, arguments, section));
    const auto& paper =
        std::get<checkpoint::PaperArchitecture>(fold.checkpoint.manifest.architecture);
    if (paper.variant == checkpoint::GeneratorVariant::kUnlabelled) continue;
    DUET_RETURN_IF_ERROR(
        AddSpace(dataset, fold, experiments::LatentLabels::kNone, arguments, section));
  }
  return absl::OkStatus();
}

report::ResultSection MakeSection(const dataset::Dataset& dataset,
                                  const std::vector<std::string>& subjects,
                                  const LatentArguments& arguments) {
  report::ResultSection section = BeginSection(
      arguments.section,
      "A clip is one point: the concatenated output of the generator's encoders, averaged over the "
      "clip's frames, drawn by t-SNE. Each fold's model has a space of its own.");
  section.text.push_back(
      "A model with a multi-hot embedding receives the class that colours the point as its label, "
      "so part of the order comes from the input. The same model with all labels zero shows what "
      "it infers from the leader only.");
  report::Table table{"Share of clips whose nearest neighbours are of their class"};
  for (const int count : kNeighbours) table.columns.push_back(absl::StrCat(count, " in the space"));
  table.decimals = 3;
  section.tables = {std::move(table)};
  section.settings = {{"data", dataset.name},
                      {"left out", absl::StrJoin(subjects, ", ")},
                      {"clips", arguments.clips},
                      {"t-SNE perplexity", absl::StrCat(arguments.perplexity)},
                      {"t-SNE seed", absl::StrCat(arguments.seed)}};
  return section;
}

absl::Status RunLatent(const LatentArguments& arguments) {
  DUET_TRY(dataset::Dataset dataset, dataset::ReadDataset(arguments.data));
  std::vector<std::string> subjects = arguments.subjects;
  if (subjects.empty()) subjects = dataset.Subjects();
  if (subjects.empty()) return LeaveSubjectOut(dataset, "").status();  // says that there is nobody
  if (arguments.subjects.empty() && subjects.size() > 1) subjects.resize(1);
  report::ResultSection section = MakeSection(dataset, subjects, arguments);
  for (const std::string& text : arguments.runs) {
    DUET_TRY(NamedRuns runs, ParseRuns(text));
    DUET_RETURN_IF_ERROR(AddModel(dataset, runs, subjects, arguments, &section));
  }
  return FinishSection(arguments.section, section);
}

}  // namespace

void AddLatentCommand(CLI::App* app, ChosenCommand* chosen) {
  const auto [arguments, command] = AddCommand(
      "latent", "Maps of the generator's latent space (Figures 6 and 7)", RunLatent, app, chosen);
  AddDataFlag(&arguments->data, command);
  command
      ->add_option("--runs", arguments->runs,
                   "output of duet-train --protocol loso, or one run; repeatable")
      ->type_name(kNamedRuns)
      ->required()
      ->allow_extra_args(false);
  command
      ->add_option("--subjects", arguments->subjects,
                   "subjects whose folds to show (default: the first subject)")
      ->delimiter(',');
  AddOption("--clips", &arguments->clips, "clips of the fold to show", command)
      ->check(CLI::IsMember({"test", "train", "all"}));
  AddNumber("--perplexity", &arguments->perplexity, 1.0, 1000.0,
            "perplexity of t-SNE; lowered for few clips", command);
  AddOption("--seed", &arguments->seed, "seed of t-SNE's initial positions", command);
  AddSectionFlags(&arguments->section, command);
}

}  // namespace duet::evaluation::program

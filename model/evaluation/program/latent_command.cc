#include <filesystem>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "model/base/status_macros.h"
#include "model/dataset/dataset.h"
#include "model/evaluation/experiments/latent.h"
#include "model/evaluation/metrics/judged_scores.h"
#include "model/evaluation/metrics/scores.h"
#include "model/evaluation/program/commands.h"
#include "model/evaluation/program/experiment.h"

namespace duet::evaluation::program {
namespace {

// Of the map that make_report.py draws: the effective number of neighbours, lowered for few clips,
// and the seed of its start.
constexpr int kPerplexity = 30, kMapSeed = 1;

struct LatentArguments : ExperimentFlags {
  std::vector<std::string> runs;
  std::string clips = "test";
};

std::string FigureName(std::string text) {
  for (char& c : text) {
    const auto byte = static_cast<unsigned char>(c);
    c = absl::ascii_isalnum(byte) ? absl::ascii_tolower(byte) : '_';
  }
  return text;
}

// Measures one latent space: a figure and a row of the table. `clips`: sequences to show.
absl::Status AddSpace(const dataset::Dataset& dataset, const std::string& model,
                      const std::string& subject, const checkpoint::Checkpoint& checkpoint,
                      const std::vector<int>& clips, experiments::LatentLabels labels,
                      report::ResultSection* section) {
  DUET_TRY(const metrics::FeatureSet features, LatentFeatures(checkpoint, dataset, clips, labels));
  const std::vector<int> classes = metrics::ClassesOf(dataset, clips);
  const bool blind = labels == experiments::LatentLabels::kNone;
  const std::string name = absl::StrCat(model, blind ? ", label withheld" : "", ", ", subject);
  DUET_TRY(const double separation, metrics::NeighbourAccuracy(features, classes));
  section->tables.front().rows.push_back({name, {separation}});
  section->figures.push_back(
      {FigureName(absl::StrCat(section->id, "_", model, blind ? "_no_label_" : "_", subject)),
       absl::StrCat("Latent space of ", model, " with ", subject, " left out",
                    blind ? ", the label vector withheld" : "", ": t-SNE of ", clips.size(),
                    " clips, one point each."),
       {{"kind", "latent"},
        {"title", name},
        {"class_names", dataset.classes},
        {"classes", classes},
        {"features", features},
        {"perplexity", kPerplexity},
        {"seed", kMapSeed}}});
  return absl::OkStatus();
}

// A model that reads labels is measured a second time without the label, which by itself separates
// the classes.
absl::Status AddModel(const dataset::Dataset& dataset, const NamedRuns& runs, const Fold& fold,
                      const std::string& which, report::ResultSection* section) {
  std::error_code error;
  // Of duet-train --protocol loso, a run for each fold; otherwise a single one.
  const bool is_run = std::filesystem::exists(runs.folder / "checkpoint", error);
  DUET_TRY(const checkpoint::Checkpoint checkpoint,
           ReadRunCheckpoint(is_run ? runs.folder : runs.folder / fold.subject));
  std::vector<int> clips = which == "train" ? fold.split.train : fold.split.test;
  if (which == "all") clips.insert(clips.end(), fold.split.train.begin(), fold.split.train.end());
  DUET_RETURN_IF_ERROR(AddSpace(dataset, runs.name, fold.subject, checkpoint, clips,
                                experiments::LatentLabels::kOwnClass, section));
  const auto& paper = std::get<checkpoint::PaperArchitecture>(checkpoint.manifest.architecture);
  if (paper.variant == checkpoint::GeneratorVariant::kUnlabelled) return absl::OkStatus();
  return AddSpace(dataset, runs.name, fold.subject, checkpoint, clips,
                  experiments::LatentLabels::kNone, section);
}

absl::Status RunLatent(const LatentArguments& arguments) {
  DUET_TRY(Experiment experiment, OpenExperiment(arguments));
  if (arguments.subjects.empty()) experiment.folds.resize(1);
  report::ResultSection section = BeginExperiment(
      arguments, experiment,
      "A clip is one point: the concatenated output of the generator's encoders, averaged over the "
      "clip's frames, drawn by t-SNE. Each fold's model has a space of its own.");
  section.text.push_back(
      "A model with a multi-hot embedding receives the class that colours the point as its label, "
      "so part of the order comes from the input. The same model with all labels zero shows what "
      "it infers from the leader only.");
  section.settings.emplace_back("clips", arguments.clips);
  section.tables = {{"Share of clips whose nearest neighbour is of their class", {"in the space"}}};
  section.tables.front().decimals = 3;
  for (const std::string& text : arguments.runs) {
    DUET_TRY(const NamedRuns runs, ParseRuns(text));
    for (const Fold& fold : experiment.folds) {
      DUET_RETURN_IF_ERROR(AddModel(experiment.dataset, runs, fold, arguments.clips, &section));
    }
  }
  return FinishSection(arguments.section, section);
}

}  // namespace

void AddLatentCommand(CLI::App* app, ChosenCommand* chosen) {
  const auto [arguments, command] = AddCommand(
      "latent", "Maps of the generator's latent space (Figures 6 and 7)", RunLatent, app, chosen);
  AddExperimentFlags("50_latent", "Latent space (Figures 6 and 7)", arguments, command);
  command
      ->add_option("--runs", arguments->runs,
                   "output of duet-train --protocol loso, or one run; repeatable. Without "
                   "--subjects, the first subject's fold is shown")
      ->type_name(kNamedRuns)
      ->required()
      ->allow_extra_args(false);
  AddOption("--clips", &arguments->clips, "clips of the fold to show", command)
      ->check(CLI::IsMember({"test", "train", "all"}));
}

}  // namespace duet::evaluation::program

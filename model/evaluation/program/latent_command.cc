#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "model/base/status_macros.h"
#include "model/evaluation/judge/judge.h"
#include "model/evaluation/program/experiment.h"

namespace duet::evaluation::program {
namespace {

// Of the map that make_report.py draws: the effective number of neighbours, lowered for few clips,
// and the seed of its start.
constexpr int kPerplexity = 30, kMapSeed = 1;

std::string FigureName(std::string text) {
  for (char& c : text) {
    const auto byte = static_cast<unsigned char>(c);
    c = absl::ascii_isalnum(byte) ? absl::ascii_tolower(byte) : '_';
  }
  return text;
}

// Measures one latent space: a figure and a row of the table. `clips`: sequences to show.
absl::Status AddSpace(const dataset::Dataset& dataset, const std::string& name,
                      const checkpoint::Checkpoint& checkpoint, const std::vector<int>& clips,
                      bool labelled, report::Section* section) {
  DUET_TRY(const metrics::FeatureSet features,
           judge::LatentFeatures(checkpoint, dataset, clips, labelled));
  const std::vector<int> classes = metrics::ClassesOf(dataset, clips);
  section->tables.front().rows.push_back({name, {metrics::NeighbourAccuracy(features, classes)}});
  section->figures.push_back({FigureName(name),
                              absl::StrCat("Latent space of ", name, " left out: t-SNE of ",
                                           clips.size(), " clips, one point each."),
                              {{"kind", "latent"},
                               {"title", name},
                               {"class_names", dataset.classes},
                               {"classes", classes},
                               {"features", features},
                               {"perplexity", kPerplexity},
                               {"seed", kMapSeed}}});
  return absl::OkStatus();
}

absl::StatusOr<report::Section> RunLatent(const ExperimentFlags& flags) {
  ExperimentFlags without_models = flags;
  without_models.runs.clear();
  DUET_TRY(Experiment experiment, OpenExperiment(without_models));
  if (flags.subjects.empty()) experiment.folds.resize(1);
  report::Section section = BeginExperiment(
      flags, experiment,
      "A clip is one point: the concatenated output of the generator's encoders, averaged over the "
      "clip's frames, drawn by t-SNE. Each fold's model has a space of its own.");
  section.text.push_back(
      "A model with a multi-hot embedding receives the class that colours the point as its label, "
      "so part of the order comes from the input. The same model with all labels zero shows what "
      "it infers from the leader only.");
  section.tables = {{"Share of clips whose nearest neighbour is of their class", {"in the space"}}};
  section.tables.front().decimals = 3;
  const std::vector<int> clips = dataset::AllSequences(experiment.dataset);
  for (const std::string& text : flags.runs) {
    DUET_TRY(const NamedRuns runs, ParseRuns(text));
    for (const Fold& fold : experiment.folds) {
      DUET_TRY(const checkpoint::Checkpoint checkpoint,
               ReadRunCheckpoint(runs.folder / fold.subject));
      DUET_RETURN_IF_ERROR(AddSpace(experiment.dataset, absl::StrCat(runs.name, ", ", fold.subject),
                                    checkpoint, clips, true, &section));
      // A model that reads labels is measured a second time without the label, which by itself
      // separates the classes.
      const auto& paper = std::get<checkpoint::PaperArchitecture>(checkpoint.manifest.architecture);
      if (paper.variant == checkpoint::GeneratorVariant::kUnlabelled) continue;
      DUET_RETURN_IF_ERROR(AddSpace(experiment.dataset,
                                    absl::StrCat(runs.name, ", label withheld, ", fold.subject),
                                    checkpoint, clips, false, &section));
    }
  }
  return section;
}

}  // namespace

Measure AddLatentCommand(CLI::App* command) {
  const auto flags = std::make_shared<ExperimentFlags>();
  AddExperimentFlags(flags.get(), command);
  command
      ->add_option("--runs", flags->runs,
                   "output of duet-train --protocol loso; repeatable. Without --subjects, the "
                   "first subject's fold is shown")
      ->type_name(kRuns)
      ->required()
      ->allow_extra_args(false);
  return [flags] { return RunLatent(*flags); };
}

}  // namespace duet::evaluation::program

#include <algorithm>
#include <iostream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "model/base/status_macros.h"
#include "model/evaluation/program/commands.h"
#include "model/evaluation/program/experiment.h"
#include "model/evaluation/program/flags.h"

namespace duet::evaluation::program {
namespace {

struct StripsArguments : ExperimentFlags {
  std::string start = "none";
};

// The clip that represents a class: of the first left-out person who has any, the one of median
// length. The rule avoids choosing by appearance.
struct Example {
  const Fold* fold = nullptr;
  int sequence = 0;
};

std::optional<Example> FindExample(const Experiment& experiment, int interaction_class) {
  for (const Fold& fold : experiment.folds) {
    std::vector<std::pair<int, int>> clips;  // frames, index
    for (const int index : fold.split.test) {
      const dataset::Sequence& sequence = experiment.dataset.sequences[static_cast<size_t>(index)];
      if (sequence.interaction_class != interaction_class) continue;
      clips.emplace_back(sequence.pair.leader.frame_count(), index);
    }
    if (clips.empty()) continue;
    std::sort(clips.begin(), clips.end());
    return Example{&fold, clips[clips.size() / 2].second};
  }
  return std::nullopt;
}

absl::StatusOr<std::vector<report::PicturedPair>> Pairs(const Experiment& experiment,
                                                        const Example& example,
                                                        const StripsArguments& arguments) {
  const dataset::Dataset& dataset = experiment.dataset;
  const motion::ClipPair& pair = dataset.sequences[static_cast<size_t>(example.sequence)].pair;
  std::vector<report::PicturedPair> pairs = {{"captured", pair.leader.poses, pair.follower.poses}};
  for (const FoldModel& model : experiment.models) {
    DUET_TRY(metrics::SampledMotions answers,
             Answers(dataset, model, *example.fold, {example.sequence}, arguments.start,
                     arguments.asked));
    for (size_t n = 0; n < answers.size(); ++n) {
      const std::string name = n == 0 ? model.name : absl::StrCat(model.name, ", another seed");
      pairs.push_back({name, pair.leader.poses, answers[n].front().follower});
    }
  }
  return pairs;
}

absl::Status AddPictures(const Experiment& experiment, const std::string& class_name,
                         const Example& example, const StripsArguments& arguments,
                         report::ResultSection* section) {
  DUET_TRY(std::vector<report::PicturedPair> pairs, Pairs(experiment, example, arguments));
  const dataset::Sequence& sequence =
      experiment.dataset.sequences[static_cast<size_t>(example.sequence)];
  const double rate = sequence.pair.leader.frame_rate_hz;
  const std::string name = absl::StrCat(section->id, "_", class_name);
  std::string of = absl::StrCat(class_name, ", clip ", sequence.id);
  if (!arguments.models.one_for_all()) {
    absl::StrAppend(&of, ", by models that never saw ", example.fold->subject);
  }
  section->figures.push_back(
      {name, absl::StrCat(of, ": leader blue, follower orange; paler on the left of the body."),
       report::PosePlot{class_name, experiment.dataset.skeleton, std::move(pairs), rate}});
  return absl::OkStatus();
}

absl::Status RunStrips(const StripsArguments& arguments) {
  DUET_TRY(Experiment experiment, OpenExperiment(arguments));
  report::ResultSection section = BeginAnswers(
      arguments, experiment,
      "One clip of each class: the clip of median length of the first left-out subject who has "
      "any. Above: the captured pair. Below: the same leader with synthesised followers.");
  section.settings.emplace_back("input about the follower's first frame", arguments.start);
  const std::vector<std::string>& classes = experiment.dataset.classes;
  for (size_t c = 0; c < classes.size(); ++c) {
    const std::optional<Example> example = FindExample(experiment, static_cast<int>(c));
    if (!example) continue;
    DUET_RETURN_IF_ERROR(AddPictures(experiment, classes[c], *example, arguments, &section));
  }
  std::cout << section.figures.size() << " figures\n";
  return FinishSection(arguments.section, section);
}

}  // namespace

void AddStripsCommand(CLI::App* app, ChosenCommand* chosen) {
  const auto [arguments, command] =
      AddCommand("strips", "Pictures of captured and synthesised pairs, still and moving",
                 RunStrips, app, chosen);
  arguments->asked.samples = 2;  // show the variety of a model that samples
  AddExperimentFlags("18_strips", "Captured and synthesised, side by side", arguments, command);
  command->get_option("--out")->required();
  AddModelFlags(ModelNeeded::kYes, &arguments->models, command);
  AddOption("--start", &arguments->start, "input about the follower's first frame", command)
      ->check(CLI::IsMember(StartNames()));
  AddSamplingFlags(&arguments->asked, command);
}

}  // namespace duet::evaluation::program

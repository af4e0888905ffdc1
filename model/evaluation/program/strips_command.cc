#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "model/evaluation/experiments/sampled_answers.h"
#include "model/evaluation/program/commands.h"
#include "model/evaluation/program/experiment.h"
#include "model/evaluation/program/fold_judge.h"
#include "model/evaluation/program/model_flags.h"
#include "model/evaluation/program/named_runs.h"

namespace duet::evaluation::program {
namespace {

// Two answers show the variety of a model that samples.
constexpr int kAnswers = 2;

struct Arguments {
  ExperimentFlags flags;
  std::string start = "none";
  experiments::AskedSamples asked;
};

// The clip that represents a class: of the first left-out person who has any, the one of median
// length. The rule avoids choosing by appearance.
struct Example {
  std::string subject;
  int sequence = 0;
};

std::optional<Example> FindExample(const dataset::Dataset& dataset,
                                   const std::vector<std::string>& subjects,
                                   int interaction_class) {
  for (const std::string& subject : subjects) {
    const absl::StatusOr<dataset::Split> split = LeaveSubjectOut(dataset, subject);
    if (!split.ok()) continue;
    std::vector<std::pair<int, int>> clips;  // frames, index
    for (const int index : split->test) {
      const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(index)];
      if (sequence.interaction_class != interaction_class) continue;
      clips.emplace_back(sequence.pair.leader.frame_count(), index);
    }
    if (clips.empty()) continue;
    std::sort(clips.begin(), clips.end());
    return Example{subject, clips[clips.size() / 2].second};
  }
  return std::nullopt;
}

absl::StatusOr<std::vector<report::PicturedPair>> Pairs(const dataset::Dataset& dataset,
                                                        const std::vector<FoldModel>& models,
                                                        const Example& example,
                                                        const Arguments& arguments) {
  const motion::ClipPair& pair = dataset.sequences[static_cast<size_t>(example.sequence)].pair;
  std::vector<report::PicturedPair> pairs = {{"captured", pair.leader.poses, pair.follower.poses}};
  experiments::AskedSamples asked = arguments.asked;
  asked.samples = kAnswers;
  for (const FoldModel& model : models) {
    absl::StatusOr<std::shared_ptr<const engine::Synthesizer>> synthesizer =
        model.load(example.subject);
    if (!synthesizer.ok()) return synthesizer.status();
    absl::StatusOr<metrics::SampledMotions> answers = AnswerWithSamples(
        **synthesizer, dataset, {example.sequence}, ParseStart(arguments.start), asked);
    if (!answers.ok()) return answers.status();
    for (size_t n = 0; n < answers->size(); ++n) {
      const std::string name = n == 0 ? model.name : absl::StrCat(model.name, ", another seed");
      pairs.push_back({name, pair.leader.poses, (*answers)[n].front().follower});
    }
  }
  return pairs;
}

absl::Status AddPictures(const dataset::Dataset& dataset, const std::vector<FoldModel>& models,
                         const std::string& class_name, const Example& example,
                         const Arguments& arguments, report::ResultSection* section) {
  absl::StatusOr<std::vector<report::PicturedPair>> pairs =
      Pairs(dataset, models, example, arguments);
  if (!pairs.ok()) return pairs.status();
  const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(example.sequence)];
  const double rate = sequence.pair.leader.frame_rate_hz;
  const std::string name = absl::StrCat(section->id, "_", class_name);
  std::string of = absl::StrCat(class_name, ", clip ", sequence.id);
  if (!arguments.flags.models.one_for_all()) {
    absl::StrAppend(&of, ", by models that never saw ", example.subject);
  }
  section->figures.push_back(
      {name, absl::StrCat(of, ": leader blue, follower orange; paler on the left of the body."),
       report::PosePlot{class_name, dataset.skeleton, *std::move(pairs), rate}});
  return absl::OkStatus();
}

report::ResultSection MakeSection(const Experiment& experiment, const Arguments& arguments) {
  report::ResultSection section = BeginExperiment(
      arguments.flags, experiment,
      "A clip of each class: of the first left-out person who has any, the one of middle length. "
      "Above the captured pair, below the same leader with synthesised followers.");
  section.settings.emplace_back("told of the follower's first frame", arguments.start);
  section.settings.emplace_back("variety", absl::StrCat(arguments.asked.variety));
  section.settings.emplace_back("seed", absl::StrCat(arguments.asked.seed));
  return section;
}

absl::Status Run(const Arguments& arguments) {
  absl::StatusOr<Experiment> experiment = OpenExperiment(arguments.flags);
  if (!experiment.ok()) return experiment.status();
  const dataset::Dataset& dataset = experiment->dataset;
  report::ResultSection section = MakeSection(*experiment, arguments);
  for (int c = 0; c < dataset.class_count(); ++c) {
    const std::optional<Example> example = FindExample(dataset, experiment->subjects, c);
    if (!example) continue;
    absl::Status status =
        AddPictures(dataset, experiment->models, dataset.classes[static_cast<size_t>(c)], *example,
                    arguments, &section);
    if (!status.ok()) return status;
  }
  std::cout << section.figures.size() << " figures\n";
  return FinishSection(arguments.flags.section, section);
}

}  // namespace

void AddStripsCommand(CLI::App* app, ChosenCommand* chosen) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app->add_subcommand("strips", "Pictures of captured and synthesised pairs, still and moving");
  AddExperimentFlags("18_strips", "Captured and synthesised, side by side", &arguments->flags,
                     command);
  command->get_option("--out")->required();
  AddModelFlags(ModelNeeded::kYes, &arguments->flags.models, command);
  command
      ->add_option("--start", arguments->start, "what the models get of the follower's first frame")
      ->check(CLI::IsMember(StartNames()))
      ->capture_default_str();
  AddSamplingFlags(&arguments->asked, command);
  RunWhenNamed(command, arguments, Run, chosen);
}

}  // namespace duet::evaluation::program

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
#include "model/evaluation/program/fold_judge.h"
#include "model/evaluation/program/model_flags.h"
#include "model/evaluation/program/named_runs.h"
#include "model/evaluation/report/pose_picture.h"
#include "model/evaluation/report/result_section.h"

namespace duet::evaluation::program {
namespace {

constexpr int kColumns = 8;
// Of a model that samples, two answers show that they differ.
constexpr int kAnswers = 2;

struct Arguments {
  std::string data;
  ModelChoice models;
  std::string start = "none";
  std::vector<std::string> subjects;
  experiments::AskedSamples asked;
  std::string out;
  std::string id = "18_strips";
  std::string title = "Captured and synthesised, side by side";
};

// Which clip stands for a class: of the first left-out person who has any, the one of middle
// length. Nobody chose it by its looks.
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
  if (!arguments.models.one_for_all()) {
    absl::StrAppend(&of, ", by models that never saw ", example.subject);
  }
  section->figures.push_back(
      {name, absl::StrCat(of, ": leader blue, follower orange; paler on the left of the body."),
       StripSvg(dataset.skeleton, class_name, *pairs, rate, kColumns)});
  section->figures.push_back({name + "_moving", absl::StrCat(of, ", in motion."),
                              MovingSvg(dataset.skeleton, class_name, *pairs, rate)});
  return absl::OkStatus();
}

report::ResultSection MakeSection(const dataset::Dataset& dataset, const Arguments& arguments) {
  report::ResultSection section;
  section.id = arguments.id;
  section.title = arguments.title;
  section.text = {
      "A clip of each class: of the first left-out person who has any, the one of middle length. "
      "Above the captured pair, below the same leader with synthesised followers."};
  if (arguments.models.one_for_all()) section.text.push_back(kOneForAll);
  section.settings = {
      {"data", absl::StrCat(dataset.name, ", ", dataset.sequences.size(), " sequences")},
      {"told of the follower's first frame", arguments.start},
      {"variety", absl::StrCat(arguments.asked.variety)},
      {"seed", absl::StrCat(arguments.asked.seed)},
      {"models' answers", arguments.models.as_served ? "as served" : "the network's own"}};
  section.command = absl::StrCat("duet-eval strips --data DIR", ModelWords(arguments.models),
                                 " --start ", arguments.start, " --variety ",
                                 arguments.asked.variety, " --seed ", arguments.asked.seed);
  section.date = report::Today();
  return section;
}

absl::Status Run(const Arguments& arguments) {
  absl::StatusOr<dataset::Dataset> dataset = dataset::ReadDataset(arguments.data);
  if (!dataset.ok()) return dataset.status();
  absl::StatusOr<std::vector<std::string>> subjects = FoldSubjects(*dataset, arguments.subjects);
  if (!subjects.ok()) return subjects.status();
  absl::StatusOr<std::vector<FoldModel>> models = OpenModels(arguments.models);
  if (!models.ok()) return models.status();
  report::ResultSection section = MakeSection(*dataset, arguments);
  for (int c = 0; c < dataset->class_count(); ++c) {
    const std::optional<Example> example = FindExample(*dataset, *subjects, c);
    if (!example) continue;
    absl::Status status = AddPictures(*dataset, *models, dataset->classes[static_cast<size_t>(c)],
                                      *example, arguments, &section);
    if (!status.ok()) return status;
  }
  std::cout << section.figures.size() << " figures\n";
  return WriteSection(section, arguments.out);
}

}  // namespace

void AddStripsCommand(CLI::App* app, ChosenCommand* chosen) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app->add_subcommand("strips", "Pictures of captured and synthesised pairs, still and moving");
  command->add_option("--data", arguments->data, "folder of captures (docs/datasets.md)")
      ->required();
  AddModelFlags(ModelNeeded::kYes, &arguments->models, command);
  command
      ->add_option("--start", arguments->start,
                   "what the models are told of the follower's first frame")
      ->check(CLI::IsMember(StartNames()))
      ->capture_default_str();
  AddSamplingFlags(&arguments->asked, command);
  command->add_option("--subjects", arguments->subjects, "folds; default: every subject")
      ->delimiter(',');
  command->add_option("--out", arguments->out, "folder of results, for duet-eval report")
      ->required();
  command->add_option("--id", arguments->id, "of the section")->capture_default_str();
  command->add_option("--title", arguments->title, "of the section")->capture_default_str();
  command->callback([arguments, chosen] { *chosen = [arguments] { return Run(*arguments); }; });
}

}  // namespace duet::evaluation::program

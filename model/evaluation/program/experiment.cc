#include "model/evaluation/program/experiment.h"

#include <algorithm>
#include <iostream>
#include <system_error>
#include <utility>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "model/base/status_macros.h"
#include "model/base/text.h"
#include "model/torch_engine/torch_synthesizer.h"

namespace duet::evaluation::program {
namespace {

// A word as a shell reads it back.
std::string ShellWord(const std::string& word) {
  const bool is_plain = !word.empty() && std::all_of(word.begin(), word.end(), [](unsigned char c) {
    return absl::ascii_isalnum(c) ||
           (c != '\0' && std::string("_-+=,./:").find(c) != std::string::npos);
  });
  return is_plain ? word : absl::StrCat("'", absl::StrReplaceAll(word, {{"'", "'\\''"}}), "'");
}

// A value with a placeholder for its path.
std::string Shown(const CLI::Option& option, const std::string& value) {
  // Without the names of its checks, which follow after colons.
  const std::string type = option.get_type_name().substr(0, option.get_type_name().find(':'));
  const std::string folders[] = {kData, kRuns, kCheckpoint, kResults};
  if (std::count(std::begin(folders), std::end(folders), type) > 0) return type;
  if (type != kNamedRuns) return ShellWord(value);
  const absl::StatusOr<NamedRuns> runs = ParseRuns(value);
  return absl::StrCat(runs.ok() ? ShellWord(runs->name) : "NAME", "=", kRuns);
}

void AppendOptions(const CLI::App& app, std::string* line) {
  for (const CLI::Option* option : app.get_options()) {
    if (option->count() == 0) continue;
    const std::string name = absl::StrCat(" ", option->get_name());
    std::vector<std::string> values;
    for (const std::string& value : option->results()) values.push_back(Shown(*option, value));
    if (option->get_expected_max() == 0) {
      *line += name;  // a flag without a value
    } else if (option->get_delimiter() != '\0') {
      absl::StrAppend(line, name, " ", absl::StrJoin(values, ","));
    } else {
      for (const std::string& value : values) absl::StrAppend(line, name, " ", value);
    }
  }
  // Groups of options are subcommands without a name.
  for (const CLI::App* group :
       app.get_subcommands([](const CLI::App* sub) { return sub->get_name().empty(); })) {
    AppendOptions(*group, line);
  }
}

}  // namespace

CLI::Option* AddNames(const char* name, std::vector<std::string>* values,
                      const std::vector<std::string>& among, const char* help, CLI::App* command) {
  return AddOption(name, values, help, command)->delimiter(',')->check(CLI::IsMember(among));
}

void AddDataFlag(std::string* data, CLI::App* command) {
  command->add_option("--data", *data, "folder of captures (docs/datasets.md)")
      ->type_name(kData)
      ->required();
}

void AddSectionFlags(SectionFlags* flags, CLI::App* command) {
  flags->command = command;
  command
      ->add_option("--out", flags->out,
                   "folder for the results, which scripts/make_report.py reads")
      ->type_name(kResults);
  AddOption("--id", &flags->id, "id of the section", command);
  AddOption("--title", &flags->title, "title of the section", command);
}

std::string RecordedCommand(const CLI::App& command) {
  std::string line = absl::StrCat("duet-eval ", command.get_name());
  AppendOptions(command, &line);
  return line;
}

std::string DescribeData(const dataset::Dataset& dataset) {
  return absl::StrCat(dataset.name, ", ", dataset.sequences.size(), " sequences");
}

report::ResultSection BeginSection(const SectionFlags& flags, const std::string& text) {
  report::ResultSection section;
  section.id = flags.id;
  section.title = flags.title;
  section.text = {text};
  section.command = RecordedCommand(*flags.command);
  section.date = report::Today();
  return section;
}

absl::Status FinishSection(const SectionFlags& flags, const report::ResultSection& section) {
  for (const report::Table& table : section.tables) std::cout << ToPlainText(table) << "\n";
  return flags.out.empty() ? absl::OkStatus() : WriteSection(section, flags.out);
}

void AddModelFlags(ModelNeeded needed, ModelChoice* models, CLI::App* command) {
  auto* source = command->add_option_group("model", "models to measure");
  source->add_option("--runs", models->runs, "output of duet-train --protocol loso; repeatable")
      ->type_name(kNamedRuns)
      ->allow_extra_args(false);
  source->add_option("--checkpoint", models->checkpoint, "one checkpoint folder for every fold")
      ->type_name(kCheckpoint);
  source->add_flag("--embedded", models->embedded, "the embedded checkpoint");
  source->require_option(needed == ModelNeeded::kYes ? 1 : 0, 1);
  AddAsServedFlag(models, command);
}

void AddAsServedFlag(ModelChoice* models, CLI::App* command) {
  command->add_flag("--as-served", models->as_served,
                    "finish the answers as a server does (default: the network's own answers)");
}

std::vector<std::string> StartNames() { return {"none", "root", "pose"}; }

experiments::StartGiven ParseStart(const std::string& name) {
  if (name == "root") return experiments::StartGiven::kRoot;
  return name == "pose" ? experiments::StartGiven::kPose : experiments::StartGiven::kNone;
}

std::string StartSuffix(experiments::StartGiven start) {
  if (start == experiments::StartGiven::kNone) return "";
  return start == experiments::StartGiven::kRoot ? "+root" : "+pose";
}

void AddStartsFlag(std::vector<std::string>* starts, CLI::App* command) {
  AddNames("--starts", starts, StartNames(),
           "input about the follower's first frame; one row per value", command);
}

void AddSamplingFlags(experiments::AskedSamples* asked, CLI::App* command) {
  AddNumber("--variety", &asked->variety, 0.0, 2.0, kVarietyHelp, command);
  AddNumber("--candidates", &asked->candidates, 1, engine::kMostCandidates,
            "samples of each window, of which the best is taken", command);
  AddNumber("--reaction", &asked->reaction, 0.0, double{engine::kMostReaction},
            "factor of what the leader's motion changes in an answer", command);
  AddOption("--seed", &asked->seed, "seed of the answers", command);
  command
      ->add_option(
          "--live", asked->live_delay,
          "answer as in a live session, this number of leader frames later; without it, the "
          "whole leader is known")
      ->type_name("FRAMES")
      ->check(CLI::Range(0, 10));
}

void AddSamplingSettings(const experiments::AskedSamples& asked, report::ResultSection* section) {
  section->settings.insert(
      section->settings.end(),
      {{"variety", absl::StrCat(asked.variety)},
       {"candidates", absl::StrCat(asked.candidates)},
       {"seed", absl::StrCat(asked.seed)},
       {"live", asked.live_delay ? absl::StrCat(*asked.live_delay, " frames of delay") : "no"}});
}

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

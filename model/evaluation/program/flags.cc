#include "model/evaluation/program/flags.h"

#include <algorithm>
#include <iostream>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "model/evaluation/program/experiment.h"

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

void AddVarietyFlag(float* variety, CLI::App* command) {
  AddNumber("--variety", variety, 0.0, 2.0,
            "variety of sampled answers; 0: the typical answer, 1: as varied as people", command);
}

void AddSeedFlag(uint64_t* seed, CLI::App* command) {
  AddOption("--seed", seed, "seed of the answers", command);
}

void AddSamplingFlags(experiments::AskedSamples* asked, CLI::App* command) {
  AddVarietyFlag(&asked->variety, command);
  AddNumber("--candidates", &asked->candidates, 1, engine::kMostCandidates,
            "samples of each window, of which the best is taken", command);
  AddNumber("--reaction", &asked->reaction, 0.0, double{engine::kMostReaction},
            "factor of what the leader's motion changes in an answer", command);
  AddSeedFlag(&asked->seed, command);
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

}  // namespace duet::evaluation::program

#include "model/evaluation/program/section_flags.h"

#include <algorithm>
#include <iostream>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "model/evaluation/program/models.h"

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

bool IsFolder(const std::string& type) {
  for (const char* folder : {kData, kRuns, kCheckpoint, kSet, kResults}) {
    if (type == folder) return true;
  }
  return false;
}

// A value with a placeholder for its path.
std::string Shown(const CLI::Option& option, const std::string& value) {
  // Without the names of its checks, which follow after colons.
  const std::string type = option.get_type_name().substr(0, option.get_type_name().find(':'));
  if (IsFolder(type)) return type;
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

void AddDataFlag(std::string* data, CLI::App* command) {
  command->add_option("--data", *data, "folder of captures (docs/datasets.md)")
      ->type_name(kData)
      ->required();
}

void AddSubjectsFlag(std::vector<std::string>* subjects, CLI::App* command) {
  command
      ->add_option("--subjects", *subjects,
                   "subjects to leave out, one at a time (default: every subject)")
      ->delimiter(',');
}

void AddSectionFlags(SectionFlags* flags, CLI::App* command) {
  flags->command = command;
  command
      ->add_option("--out", flags->out,
                   "folder for the results, which scripts/make_report.py reads")
      ->type_name(kResults);
  command->add_option("--id", flags->id, "id of the section")->capture_default_str();
  command->add_option("--title", flags->title, "title of the section")->capture_default_str();
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

}  // namespace duet::evaluation::program

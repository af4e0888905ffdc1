#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/base/status_macros.h"
#include "model/evaluation/program/experiment.h"

namespace duet::evaluation::program {
namespace {

struct Command {
  const char* name;
  const char* id;     // of its section, unless --id is given
  const char* title;  // likewise
  const char* help;
  Measure (*add)(CLI::App* command);
};

constexpr Command kCommands[] = {
    {"folds", "10_folds", "Leave one subject out",
     "Figures of models and baselines, leaving one subject out", AddFoldsCommand},
    {"samples", "14_samples", "Many answers to one leader",
     "Figures of many answers to each leader", AddSamplesCommand},
    {"told-apart", "17_told_apart", "Told apart from captured pairs",
     "How well a classifier distinguishes answers from captured pairs", AddToldApartCommand},
    {"plausible", "19_plausible", "Plausible followers of foreign leaders",
     "What a viewer would notice in followers of any leaders", AddPlausibleCommand},
    {"sweep", "30_sweep", "Mix, match and avoid: what label weights do",
     "Effect of raising and lowering label weights", AddSweepCommand},
    {"mixes", "32_mixes", "Mixes and reaction", "What mixes do, and how followers react",
     AddMixesCommand},
    {"augmentation", "40_augmentation", "Synthetic motion as training material (Table 6)",
     "A classifier with and without synthetic training motion (Table 6)", AddAugmentationCommand},
    {"latent", "50_latent", "Latent space (Figures 6 and 7)",
     "Maps of the generator's latent space (Figures 6 and 7)", AddLatentCommand},
};

struct Output {
  std::string folder;  // empty: only print
  std::string id, title;
};

absl::Status Run(const CLI::App& command, const Measure& measure, const Output& output) {
  DUET_TRY(report::Section section, measure());
  section.id = output.id;
  section.title = output.title;
  section.command = RecordedCommand(command);
  for (report::Figure& figure : section.figures) {
    figure.name = absl::StrCat(section.id, "_", figure.name);
  }
  for (const std::string& text : section.text) std::cout << text << "\n\n";
  for (const report::Table& table : section.tables) std::cout << ToPlainText(table) << "\n";
  return output.folder.empty() ? absl::OkStatus() : WriteSection(section, output.folder);
}

}  // namespace

void AddCommands(CLI::App* app, std::function<absl::Status()>* chosen) {
  app->require_subcommand(1);
  for (const Command& one : kCommands) {
    CLI::App* command = app->add_subcommand(one.name, one.help);
    const Measure measure = one.add(command);
    const auto output = std::make_shared<Output>(Output{"", one.id, one.title});
    command
        ->add_option("--out", output->folder,
                     "folder for the results, which scripts/make_report.py reads")
        ->type_name(kFolder);
    command->add_option("--id", output->id, "id of the section")->capture_default_str();
    command->add_option("--title", output->title, "title of the section")->capture_default_str();
    command->callback([=] { *chosen = [=] { return Run(*command, measure, *output); }; });
  }
}

std::string RecordedCommand(const CLI::App& command) {
  std::string line = absl::StrCat("duet-eval ", command.get_name());
  for (const CLI::Option* option : command.get_options()) {
    if (option->count() == 0) continue;
    absl::StrAppend(&line, " ", option->get_name());
    if (option->get_expected_max() == 0) continue;  // a flag without a value
    std::vector<std::string> values = option->results();
    const std::string type = option->get_type_name();
    for (std::string& value : values) {
      if (type == kRuns) value = absl::StrCat(value.substr(0, value.find('=') + 1), "RUNS");
      if (type.rfind(kFolder, 0) == 0) value = kFolder;  // names of checks may follow
      if (value.find(' ') != std::string::npos) value = absl::StrCat("'", value, "'");
    }
    const bool listed = option->get_delimiter() != '\0';
    absl::StrAppend(
        &line, " ",
        absl::StrJoin(values, listed ? "," : absl::StrCat(" ", option->get_name(), " ")));
  }
  return line;
}

}  // namespace duet::evaluation::program

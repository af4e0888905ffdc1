#ifndef DUET_MODEL_EVALUATION_PROGRAM_COMMANDS_H_
#define DUET_MODEL_EVALUATION_PROGRAM_COMMANDS_H_

#include <CLI/CLI.hpp>
#include <functional>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "model/evaluation/report/section.h"

namespace duet::evaluation::program {

// What a command measures when its flags have been parsed: the text, tables, figures and settings
// of a section.
using Measure = std::function<absl::StatusOr<report::Section>()>;

// The commands of duet-eval. Each adds its flags to its command line.
Measure AddFoldsCommand(CLI::App* command);
Measure AddSamplesCommand(CLI::App* command);
Measure AddPlausibleCommand(CLI::App* command);
Measure AddToldApartCommand(CLI::App* command);
Measure AddSweepCommand(CLI::App* command);
Measure AddMixesCommand(CLI::App* command);
Measure AddAugmentationCommand(CLI::App* command);
Measure AddLatentCommand(CLI::App* command);

// Adds all of them to `app`, each with --out, --id and --title. The one that a command line names
// stores in `chosen` what measures, prints the section and, with --out, writes it.
void AddCommands(CLI::App* app, std::function<absl::Status()>* chosen);

// Type names of folders on a command line: a section records them instead of the folders.
// "[NAME=]RUNS" keeps the name.
inline constexpr char kFolder[] = "FOLDER";
inline constexpr char kRuns[] = "[NAME=]RUNS";

// The command line that was parsed: every flag that was given, in the order in which they are
// declared.
std::string RecordedCommand(const CLI::App& command);

}  // namespace duet::evaluation::program

#endif  // DUET_MODEL_EVALUATION_PROGRAM_COMMANDS_H_

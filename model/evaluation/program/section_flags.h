#ifndef DUET_MODEL_EVALUATION_PROGRAM_SECTION_FLAGS_H_
#define DUET_MODEL_EVALUATION_PROGRAM_SECTION_FLAGS_H_

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "model/dataset/dataset.h"
#include "model/evaluation/program/commands.h"
#include "model/evaluation/report/result_section.h"

// What every command shares: its flags for the data and the section, and how a section begins and
// ends.

namespace duet::evaluation::program {

// Folders on a command line. The type name is the placeholder that a recorded command shows instead
// of the path; "[NAME=]RUNS" keeps the name.
inline constexpr char kData[] = "DIR";
inline constexpr char kRuns[] = "RUNS";
inline constexpr char kNamedRuns[] = "[NAME=]RUNS";
inline constexpr char kCheckpoint[] = "CHECKPOINT";
inline constexpr char kSet[] = "SET";
inline constexpr char kResults[] = "RESULTS";

struct SectionFlags {
  std::string id, title;              // set before the flags are added: they are the defaults
  std::string out{};                  // empty: only print the tables
  const CLI::App* command = nullptr;  // outlives the flags
};

// --data, required
void AddDataFlag(std::string* data, CLI::App* command);
// --subjects
void AddSubjectsFlag(std::vector<std::string>* subjects, CLI::App* command);
// --out, --id, --title
void AddSectionFlags(SectionFlags* flags, CLI::App* command);

// Stores `run` in `chosen` when the command line names `command`.
template <typename Arguments>
void RunWhenNamed(CLI::App* command, const std::shared_ptr<Arguments>& arguments,
                  absl::Status (*run)(const Arguments&), ChosenCommand* chosen) {
  command->callback(
      [arguments, run, chosen] { *chosen = [arguments, run] { return run(*arguments); }; });
}

// The command line that was parsed, with placeholders for the folders: every flag that was given,
// in the order in which they are declared.
std::string RecordedCommand(const CLI::App& command);

// "sbu, 282 sequences", for a section's settings.
std::string DescribeData(const dataset::Dataset& dataset);

// A section with its id, title, first paragraph, command and date.
report::ResultSection BeginSection(const SectionFlags& flags, const std::string& text);

// Prints the tables, and writes the section if --out is given.
absl::Status FinishSection(const SectionFlags& flags, const report::ResultSection& section);

}  // namespace duet::evaluation::program

#endif  // DUET_MODEL_EVALUATION_PROGRAM_SECTION_FLAGS_H_

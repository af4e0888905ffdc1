#ifndef DUET_MODEL_EVALUATION_PROGRAM_FLAGS_H_
#define DUET_MODEL_EVALUATION_PROGRAM_FLAGS_H_

#include <CLI/CLI.hpp>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "model/base/program_flags.h"
#include "model/dataset/dataset.h"
#include "model/evaluation/experiments/answers.h"
#include "model/evaluation/program/commands.h"
#include "model/evaluation/report/result_section.h"

// What commands share: their flags, and how a section begins and ends.

namespace duet::evaluation::program {

// Folders on a command line. The type name is the placeholder that a recorded command shows instead
// of the path; "[NAME=]RUNS" keeps the name.
inline constexpr char kData[] = "DIR";
inline constexpr char kRuns[] = "RUNS";
inline constexpr char kNamedRuns[] = "[NAME=]RUNS";
inline constexpr char kCheckpoint[] = "CHECKPOINT";
inline constexpr char kResults[] = "RESULTS";

struct SectionFlags {
  std::string id, title;              // set before the flags are added: they are the defaults
  std::string out{};                  // empty: only print the tables
  const CLI::App* command = nullptr;  // outlives the flags
};

// An option whose default --help shows.
template <typename Value>
CLI::Option* AddOption(const char* name, Value* value, const char* help, CLI::App* command) {
  return command->add_option(name, *value, help)->capture_default_str();
}
// The same for a number, or several, from `least` to `most`.
template <typename Value, typename Number>
CLI::Option* AddNumber(const char* name, Value* value, Number least, Number most, const char* help,
                       CLI::App* command) {
  return AddOption(name, value, help, command)->check(base::InRange(least, most));
}
// The same for values of `among`, separated by commas.
CLI::Option* AddNames(const char* name, std::vector<std::string>* values,
                      const std::vector<std::string>& among, const char* help, CLI::App* command);

// --data, required
void AddDataFlag(std::string* data, CLI::App* command);
// --out, --id, --title
void AddSectionFlags(SectionFlags* flags, CLI::App* command);

// A command of `app`, which runs when the command line names it, and its arguments.
template <typename Arguments>
std::pair<Arguments*, CLI::App*> AddCommand(const char* name, const char* help,
                                            absl::Status (*run)(const Arguments&), CLI::App* app,
                                            ChosenCommand* chosen) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app->add_subcommand(name, help);
  command->callback(
      [arguments, run, chosen] { *chosen = [arguments, run] { return run(*arguments); }; });
  return {arguments.get(), command};
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

// The models of a command line.
struct ModelChoice {
  std::vector<std::string> runs;  // [NAME=]RUNS each, a model per fold
  std::string checkpoint;         // one model for every fold
  bool embedded = false;          // likewise, the one inside the program
  bool as_served = false;         // finished as a server finishes them (engine::PipelineOptions)

  bool one_for_all() const { return embedded || !checkpoint.empty(); }
};

// --runs, --checkpoint, --embedded, --as-served. Exactly one source of models, or at most one.
enum class ModelNeeded { kYes, kNo };
void AddModelFlags(ModelNeeded needed, ModelChoice* models, CLI::App* command);

// --as-served
void AddAsServedFlag(ModelChoice* models, CLI::App* command);

// Values of --starts: "none", "root" and "pose". ParseStart requires one of them.
std::vector<std::string> StartNames();
experiments::StartGiven ParseStart(const std::string& name);
// The suffix of a row's name: "", "+root", "+pose".
std::string StartSuffix(experiments::StartGiven start);

// --starts
void AddStartsFlag(std::vector<std::string>* starts, CLI::App* command);

// --variety
void AddVarietyFlag(float* variety, CLI::App* command);
// --seed
void AddSeedFlag(uint64_t* seed, CLI::App* command);
// --variety, --candidates, --reaction, --seed, --live
void AddSamplingFlags(experiments::AskedSamples* asked, CLI::App* command);

// The values of AddSamplingFlags as settings of a section.
void AddSamplingSettings(const experiments::AskedSamples& asked, report::ResultSection* section);

}  // namespace duet::evaluation::program

#endif  // DUET_MODEL_EVALUATION_PROGRAM_FLAGS_H_

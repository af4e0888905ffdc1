#ifndef DUET_MODEL_EVALUATION_PROGRAM_EXPERIMENT_H_
#define DUET_MODEL_EVALUATION_PROGRAM_EXPERIMENT_H_

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "model/base/program_flags.h"
#include "model/checkpoint/checkpoint.h"
#include "model/dataset/dataset.h"
#include "model/engine/synthesizer.h"
#include "model/evaluation/experiments/answers.h"
#include "model/evaluation/metrics/scores.h"
#include "model/evaluation/program/commands.h"
#include "model/evaluation/report/result_section.h"

// What commands share: their flags, how a section begins and ends, the models that a command line
// names, the runs of duet-train that they come from, and people left out of their training, on whom
// they are measured.

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

inline constexpr char kVarietyHelp[] =
    "variety of sampled answers; 0: the typical answer, 1: as varied as people";
// --variety, --candidates, --reaction, --seed, --live
void AddSamplingFlags(experiments::AskedSamples* asked, CLI::App* command);

// The values of AddSamplingFlags as settings of a section.
void AddSamplingSettings(const experiments::AskedSamples& asked, report::ResultSection* section);

using SharedSynthesizer = std::shared_ptr<const engine::Synthesizer>;

// Runs of duet-train, and their name in tables.
struct NamedRuns {
  std::string name;
  std::filesystem::path folder;
};

// Parses "ours=DIR", or "DIR", which is named by its last part. Errors: INVALID_ARGUMENT.
absl::StatusOr<NamedRuns> ParseRuns(const std::string& text);

// The only checkpoint below a run's folder, <run>/checkpoint/<name>/<version>. Errors: NOT_FOUND.
absl::StatusOr<checkpoint::Checkpoint> ReadRunCheckpoint(const std::filesystem::path& run);

// The generator of a fold: of <runs>/<subject>, as written by duet-train --protocol loso.
// `as_served`: with constant limb lengths on the leader's floor, as a server answers; otherwise the
// network's own answer.
absl::StatusOr<SharedSynthesizer> LoadFoldModel(const std::filesystem::path& runs,
                                                const std::string& subject, bool as_served);

// A model by its name in the tables, and its generator for the fold without a subject.
struct FoldModel {
  std::string name;
  std::function<absl::StatusOr<SharedSynthesizer>(const std::string& subject)> load;
};

// Errors: INVALID_ARGUMENT for runs without a name; those of reading a checkpoint.
absl::StatusOr<std::vector<FoldModel>> OpenModels(const ModelChoice& choice);

struct ExperimentFlags {
  std::string data;
  ModelChoice models;
  std::vector<std::string> subjects;
  SectionFlags section;
  // Set before the flags are added: they are the defaults.
  std::vector<std::string> starts = {"none", "pose"};
  experiments::AskedSamples asked;
};

// --data, --subjects and those of the section.
void AddExperimentFlags(const std::string& id, const std::string& title, ExperimentFlags* flags,
                        CLI::App* command);
// The same, and those of the models, their starts and their sampling.
void AddAnswersFlags(const std::string& id, const std::string& title, ExperimentFlags* flags,
                     CLI::App* command);

// One subject left out of training.
struct Fold {
  std::string subject;
  dataset::Split split;
};

// A fold for each subject in `asked`, or, if it is empty, for every subject of the data set.
// Errors: INVALID_ARGUMENT for a data set that names no subject; LeaveSubjectOut's.
absl::StatusOr<std::vector<Fold>> LeaveOut(const dataset::Dataset& dataset,
                                           const std::vector<std::string>& asked);

// The data, folds and models that the flags name.
struct Experiment {
  dataset::Dataset dataset;
  std::vector<Fold> folds;
  std::vector<FoldModel> models;
};

// Errors: those of ReadDataset, LeaveOut and OpenModels.
absl::StatusOr<Experiment> OpenExperiment(const ExperimentFlags& flags);

// The answers of a fold's model to sequences of the data set. Errors: those of loading the model
// and of AnswerWithSamples.
absl::StatusOr<metrics::SampledMotions> Answers(const dataset::Dataset& dataset,
                                                const FoldModel& model, const Fold& fold,
                                                const std::vector<int>& sequences,
                                                const std::string& start,
                                                const experiments::AskedSamples& asked);

// BeginSection with the settings of every experiment: the data, the subjects left out, and how the
// models' answers are finished.
report::ResultSection BeginExperiment(const ExperimentFlags& flags, const Experiment& experiment,
                                      const std::string& text);
// The same with the sampling of the answers, for commands of AddAnswersFlags.
report::ResultSection BeginAnswers(const ExperimentFlags& flags, const Experiment& experiment,
                                   const std::string& text);

}  // namespace duet::evaluation::program

#endif  // DUET_MODEL_EVALUATION_PROGRAM_EXPERIMENT_H_

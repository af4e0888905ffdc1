#ifndef DUET_MODEL_EVALUATION_PROGRAM_EXPERIMENT_H_
#define DUET_MODEL_EVALUATION_PROGRAM_EXPERIMENT_H_

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "model/base/program_flags.h"
#include "model/checkpoint/checkpoint.h"
#include "model/dataset/dataset.h"
#include "model/engine/label_track.h"
#include "model/engine/synthesizer.h"
#include "model/evaluation/judge/judge.h"
#include "model/evaluation/metrics/scores.h"
#include "model/evaluation/report/report.h"

namespace duet::evaluation::program {

// What commands share: their flags, the models that a command line names, people left out of
// training, on whom models are measured, and the answers of models to captured leaders.

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
// A folder; the option is required unless there is a default.
CLI::Option* AddFolder(const char* name, std::string* folder, const char* help, CLI::App* command);

// What a request to a model has beside leader, labels and seed.
struct Asked {
  std::string start = "none";  // what it tells of the follower's first frame, or "root" or "pose"
  int samples = 1;             // answers to each leader; a model that does not sample gives one
  float variety = 1;
  uint64_t seed = 0;  // of a whole set of answers
  int candidates = engine::kDefaultCandidates;
  float reaction = 1;  // engine::Sampling::reaction
  // Answered live, with so many frames of delay. Absent: with the whole leader known.
  std::optional<int> live_delay = std::nullopt;
};

// The flags that commands may have. What a command sets before it adds them are the defaults.
struct ExperimentFlags {
  std::string data;
  std::vector<std::string> subjects;

  // Models: exactly one kind.
  std::vector<std::string> runs;  // [NAME=]RUNS each, a model per fold
  std::string checkpoint;         // one model for every fold
  bool embedded = false;          // likewise, the one inside the program
  bool as_served = false;         // finished as a server finishes them (engine::PipelineOptions)

  std::vector<std::string> starts = {"none", "pose"};  // a row of each model for each
  Asked asked;
};

// --data, --subjects
void AddExperimentFlags(ExperimentFlags* flags, CLI::App* command);
// --runs, --checkpoint, --embedded, --as-served
void AddModelFlags(ExperimentFlags* flags, CLI::App* command);
// --starts
void AddStartsFlag(ExperimentFlags* flags, CLI::App* command);
// --samples, --variety, --candidates, --reaction, --seed, --live
void AddSamplingFlags(Asked* asked, CLI::App* command);
// All of them.
void AddAnswersFlags(ExperimentFlags* flags, CLI::App* command);

using SharedSynthesizer = std::shared_ptr<const engine::Synthesizer>;

// A model by its name in the tables, its generator for the fold without a subject, and what it is
// asked.
struct FoldModel {
  std::string name;
  std::function<absl::StatusOr<SharedSynthesizer>(const std::string& subject)> load;
  Asked asked;
};

// Runs of duet-train and their name in tables: "ours=DIR", or "DIR", which is named by its last
// part. Errors: INVALID_ARGUMENT.
struct NamedRuns {
  std::string name;
  std::filesystem::path folder;
};
absl::StatusOr<NamedRuns> ParseRuns(const std::string& text);

// The only checkpoint below a run's folder, <run>/checkpoint/<name>/<version>. Errors: NOT_FOUND.
absl::StatusOr<checkpoint::Checkpoint> ReadRunCheckpoint(const std::filesystem::path& run);

// The models that flags name; a fold's is of <runs>/<subject>, as written by duet-train --protocol
// loso. Errors: INVALID_ARGUMENT for runs without a name; those of reading a checkpoint.
absl::StatusOr<std::vector<FoldModel>> OpenModels(const ExperimentFlags& flags);

// One subject left out of training.
struct Fold {
  std::string subject;
  dataset::Split split;
};

// A fold for each subject in `asked`, or, if it is empty, for every subject of the data set.
// Errors: INVALID_ARGUMENT for a data set that names no subject; LeaveSubjectOut's.
absl::StatusOr<std::vector<Fold>> LeaveOut(const dataset::Dataset& dataset,
                                           const std::vector<std::string>& asked);

// The data, folds and models that the flags name: every model once for each start, which its name
// shows ("+root", "+pose").
struct Experiment {
  dataset::Dataset dataset;
  std::vector<Fold> folds;
  std::vector<FoldModel> models;
};

// Errors: those of ReadDataset, LeaveOut and OpenModels.
absl::StatusOr<Experiment> OpenExperiment(const ExperimentFlags& flags);

// "sbu, 282 sequences", for a section's settings.
std::string DescribeData(const dataset::Dataset& dataset);

// A section with this paragraph and the settings of every experiment: the data, the subjects left
// out, and how the models' answers are finished.
report::Section BeginExperiment(const ExperimentFlags& flags, const Experiment& experiment,
                                const std::string& text);

// FAILED_PRECONDITION if a model's classes or joints differ from the data's, or if it does not
// accept the start.
absl::Status CheckModelTakes(const engine::ModelDescription& model, const dataset::Dataset& dataset,
                             const std::string& start);

// The label vector of one class at weight 1. Shapes: returns [classes].
std::vector<float> OneClass(int classes, int interaction_class);

// A leader, and the labels and the seed to answer it with.
struct LabelledLeader {
  const dataset::Sequence* sequence;
  std::vector<float> labels;
  uint64_t seed = 0;
};

// The followers of many leaders, as a server makes them, with several windows per evaluation of the
// network: much faster than one by one. Returns a follower for each, in order; fails if one fails.
absl::StatusOr<std::vector<motion::Poses>> SynthesizeSequences(
    const engine::Synthesizer& synthesizer, absl::Span<const LabelledLeader> leaders,
    const Asked& asked);

// The seed of the n-th answer to a sequence. No two leaders share a seed: with common noise, their
// answers would vary less than in use.
uint64_t SeedOf(const Asked& asked, const dataset::Dataset& dataset, int sequence, int n);

// The answers to sequences of the data set, each in its own class at weight 1. Errors: those of
// CheckModelTakes and of the network. Shapes: returns [samples][sequences].
absl::StatusOr<metrics::SampledMotions> AnswerWithSamples(const engine::Synthesizer& synthesizer,
                                                          const dataset::Dataset& dataset,
                                                          const std::vector<int>& sequences,
                                                          const Asked& asked);

// Trains the judge of each fold, only on the captured followers of the fold's training sequences.
// Prints the time to stderr. Errors: MotionClassifier::Train's.
absl::StatusOr<std::vector<judge::MotionClassifier>> TrainJudges(const dataset::Dataset& dataset,
                                                                 const std::vector<Fold>& folds);

// One answer to each test leader of each fold. Shapes: [folds][test].
using FoldAnswers = std::vector<std::vector<metrics::ScoredMotion>>;
// A model's answers, each in the class of its sequence at weight 1. Writes progress to stderr.
// Errors: those of loading the model and of AnswerWithSamples. Shapes: returns [samples].
absl::StatusOr<std::vector<FoldAnswers>> AnswerFolds(const Experiment& experiment,
                                                     const FoldModel& model);
// The captured followers.
FoldAnswers CapturedAnswers(const Experiment& experiment);
// The results of each fold's judge. Shapes: judges and answers [folds].
std::vector<metrics::JudgedFold> JudgeFolds(const std::vector<judge::MotionClassifier>& judges,
                                            const dataset::Dataset& dataset,
                                            const FoldAnswers& answers);

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

#endif  // DUET_MODEL_EVALUATION_PROGRAM_EXPERIMENT_H_

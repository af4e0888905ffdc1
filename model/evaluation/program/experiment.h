#ifndef DUET_MODEL_EVALUATION_PROGRAM_EXPERIMENT_H_
#define DUET_MODEL_EVALUATION_PROGRAM_EXPERIMENT_H_

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "model/checkpoint/checkpoint.h"
#include "model/dataset/dataset.h"
#include "model/engine/synthesizer.h"
#include "model/evaluation/experiments/answers.h"
#include "model/evaluation/metrics/scores.h"
#include "model/evaluation/program/flags.h"
#include "model/evaluation/report/result_section.h"

// The models that a command line names, the runs of duet-train that they come from, and people left
// out of their training, on whom they are measured.

namespace duet::evaluation::program {

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

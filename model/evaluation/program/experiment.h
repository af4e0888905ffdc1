#ifndef DUET_MODEL_EVALUATION_PROGRAM_EXPERIMENT_H_
#define DUET_MODEL_EVALUATION_PROGRAM_EXPERIMENT_H_

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "model/dataset/dataset.h"
#include "model/evaluation/experiments/sampled_answers.h"
#include "model/evaluation/metrics/sampled_scores.h"
#include "model/evaluation/program/models.h"
#include "model/evaluation/program/section_flags.h"
#include "model/evaluation/report/result_section.h"

// Shared by the commands that measure models on people left out of their training.

namespace duet::evaluation::program {

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

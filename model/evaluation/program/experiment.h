#ifndef DUET_MODEL_EVALUATION_PROGRAM_EXPERIMENT_H_
#define DUET_MODEL_EVALUATION_PROGRAM_EXPERIMENT_H_

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "model/dataset/dataset.h"
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
};

// --data, --subjects and those of the section; not those of the models.
void AddExperimentFlags(const std::string& id, const std::string& title, ExperimentFlags* flags,
                        CLI::App* command);

// The data and the models that the flags name.
struct Experiment {
  dataset::Dataset dataset;
  std::vector<std::string> subjects;  // left out in turn
  std::vector<FoldModel> models;
};

// Errors: those of ReadDataset, FoldSubjects and OpenModels.
absl::StatusOr<Experiment> OpenExperiment(const ExperimentFlags& flags);

// BeginSection with the settings of every experiment: the data, the subjects left out, and how the
// models' answers are finished.
report::ResultSection BeginExperiment(const ExperimentFlags& flags, const Experiment& experiment,
                                      const std::string& text);

}  // namespace duet::evaluation::program

#endif  // DUET_MODEL_EVALUATION_PROGRAM_EXPERIMENT_H_

#ifndef DUET_MODEL_EVALUATION_PROGRAM_EXPERIMENT_H_
#define DUET_MODEL_EVALUATION_PROGRAM_EXPERIMENT_H_

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "model/dataset/dataset.h"
#include "model/evaluation/program/models.h"
#include "model/evaluation/report/result_section.h"

// What the commands share that measure models on people left out of their training.

namespace duet::evaluation::program {

struct ExperimentFlags {
  std::string data;
  ModelChoice models;
  std::vector<std::string> subjects;
  std::string out;
  std::string id, title;  // of the section; set before the flags are added, they are the defaults
};

// --data, --subjects, --out, --id, --title; not those of the models.
void AddExperimentFlags(ExperimentFlags* flags, CLI::App* command);

// What the flags name, read.
struct Experiment {
  dataset::Dataset dataset;
  std::vector<std::string> subjects;  // who is left out in turn
  std::vector<FoldModel> models;
};

// Errors: those of ReadDataset, FoldSubjects and OpenModels.
absl::StatusOr<Experiment> OpenExperiment(const ExperimentFlags& flags);

// A section with its id, title, text, date, and the settings that every experiment has: the data,
// who is left out, and what is done to the models' answers.
report::ResultSection BeginSection(const ExperimentFlags& flags, const Experiment& experiment,
                                   const std::string& text);

// Prints the tables, and writes the section where a folder was asked for.
absl::Status FinishSection(const ExperimentFlags& flags, const report::ResultSection& section);

}  // namespace duet::evaluation::program

#endif  // DUET_MODEL_EVALUATION_PROGRAM_EXPERIMENT_H_

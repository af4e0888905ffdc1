#ifndef DUET_MODEL_EVALUATION_PROGRAM_MODELS_H_
#define DUET_MODEL_EVALUATION_PROGRAM_MODELS_H_

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "model/engine/synthesizer.h"

namespace duet::evaluation::program {

// The models of a command line.
struct ModelChoice {
  std::vector<std::string> runs;  // [NAME=]RUNS each, a model per fold
  std::string checkpoint;         // one model for every fold
  bool embedded = false;          // likewise, the one inside the program
  bool as_served = false;         // finished as a server finishes them (engine::PipelineOptions)

  bool one_for_all() const { return embedded || !checkpoint.empty(); }
};

// A model by its name in the tables, and its generator for the fold without a subject.
struct FoldModel {
  std::string name;
  std::function<absl::StatusOr<std::shared_ptr<const engine::Synthesizer>>(
      const std::string& subject)>
      load;
};

// Errors: INVALID_ARGUMENT for runs without a name; those of reading a checkpoint.
absl::StatusOr<std::vector<FoldModel>> OpenModels(const ModelChoice& choice);

}  // namespace duet::evaluation::program

#endif  // DUET_MODEL_EVALUATION_PROGRAM_MODELS_H_

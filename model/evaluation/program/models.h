#ifndef DUET_MODEL_EVALUATION_PROGRAM_MODELS_H_
#define DUET_MODEL_EVALUATION_PROGRAM_MODELS_H_

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "model/checkpoint/checkpoint.h"
#include "model/engine/synthesizer.h"

// The models that a command line names, and the runs of duet-train that they come from.

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
  std::function<absl::StatusOr<SharedSynthesizer>(const std::string& subject)> load;
};

// Errors: INVALID_ARGUMENT for runs without a name; those of reading a checkpoint.
absl::StatusOr<std::vector<FoldModel>> OpenModels(const ModelChoice& choice);

}  // namespace duet::evaluation::program

#endif  // DUET_MODEL_EVALUATION_PROGRAM_MODELS_H_

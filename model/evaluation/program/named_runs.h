#ifndef DUET_MODEL_EVALUATION_PROGRAM_NAMED_RUNS_H_
#define DUET_MODEL_EVALUATION_PROGRAM_NAMED_RUNS_H_

#include <filesystem>
#include <string>

#include "absl/status/statusor.h"
#include "model/evaluation/experiments/synthesizer_method.h"

namespace duet::evaluation::program {

// Runs of duet-train, and their name in tables.
struct NamedRuns {
  std::string name;
  std::filesystem::path folder;
};

// Parses "ours=DIR", or "DIR", which is named by its last part. Errors: INVALID_ARGUMENT.
absl::StatusOr<NamedRuns> ParseRuns(const std::string& text);

// "none", "root" or "pose", and the suffix of a row's name: "", "+root", "+pose". Requires one of
// StartNames.
experiments::StartGiven ParseStart(const std::string& name);
std::vector<std::string> StartNames();
std::string StartSuffix(experiments::StartGiven start);

}  // namespace duet::evaluation::program

#endif  // DUET_MODEL_EVALUATION_PROGRAM_NAMED_RUNS_H_

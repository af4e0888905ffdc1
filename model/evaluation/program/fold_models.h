#ifndef DUET_MODEL_EVALUATION_PROGRAM_FOLD_MODELS_H_
#define DUET_MODEL_EVALUATION_PROGRAM_FOLD_MODELS_H_

#include <filesystem>
#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "model/checkpoint/checkpoint.h"
#include "model/engine/synthesizer.h"

namespace duet::evaluation::program {

// The only checkpoint below a run's folder, <run>/checkpoint/<name>/<version>. Errors: NOT_FOUND.
absl::StatusOr<checkpoint::Checkpoint> ReadRunCheckpoint(const std::filesystem::path& run);

// The generator of a fold: of <runs>/<subject>, as written by duet-train --protocol loso.
// `as_served`: with constant limb lengths on the leader's floor, as a server answers; otherwise the
// network's own answer.
absl::StatusOr<std::shared_ptr<const engine::Synthesizer>> LoadFoldModel(
    const std::filesystem::path& runs, const std::string& subject, bool as_served);

}  // namespace duet::evaluation::program

#endif  // DUET_MODEL_EVALUATION_PROGRAM_FOLD_MODELS_H_

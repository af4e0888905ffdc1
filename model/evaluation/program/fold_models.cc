#include "model/evaluation/program/fold_models.h"

#include <system_error>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "model/torch_engine/torch_synthesizer.h"

namespace duet::evaluation::program {
namespace {

namespace fs = std::filesystem;

absl::StatusOr<fs::path> FindCheckpoint(const fs::path& run) {
  std::vector<fs::path> found;
  std::error_code error;
  for (const auto& name : fs::directory_iterator(run / "checkpoint", error)) {
    for (const auto& version : fs::directory_iterator(name.path(), error)) {
      // A dot marks an unfinished write of an interrupted run.
      if (version.path().filename().string().front() != '.') found.push_back(version.path());
    }
  }
  if (found.size() == 1) return found[0];
  return absl::NotFoundError(absl::StrCat(run.string(), ": ", found.size(),
                                          " checkpoints, wanted one finished run of duet-train"));
}

}  // namespace

absl::StatusOr<checkpoint::Checkpoint> ReadRunCheckpoint(const fs::path& run) {
  absl::StatusOr<fs::path> folder = FindCheckpoint(run);
  if (!folder.ok()) return folder.status();
  return checkpoint::ReadCheckpoint(*folder);
}

absl::StatusOr<std::shared_ptr<const engine::Synthesizer>> LoadFoldModel(const fs::path& runs,
                                                                         const std::string& subject,
                                                                         bool as_served) {
  absl::StatusOr<checkpoint::Checkpoint> checkpoint = ReadRunCheckpoint(runs / subject);
  if (!checkpoint.ok()) return checkpoint.status();
  absl::StatusOr<std::unique_ptr<engine::Synthesizer>> synthesizer =
      torch_engine::MakeTorchSynthesizer(*checkpoint, {as_served, as_served, as_served});
  if (!synthesizer.ok()) return synthesizer.status();
  return std::shared_ptr<const engine::Synthesizer>(*std::move(synthesizer));
}

}  // namespace duet::evaluation::program

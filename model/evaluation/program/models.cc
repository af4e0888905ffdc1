#include "model/evaluation/program/models.h"

#include <system_error>
#include <utility>

#include "absl/strings/str_cat.h"
#include "model/base/text.h"
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
  return absl::NotFoundError(absl::StrCat(run.string(),
                                          ": expected one finished run of duet-train, got ",
                                          found.size(), " checkpoints"));
}

absl::StatusOr<SharedSynthesizer> Share(
    absl::StatusOr<std::unique_ptr<engine::Synthesizer>> synthesizer) {
  if (!synthesizer.ok()) return synthesizer.status();
  return SharedSynthesizer(*std::move(synthesizer));
}

absl::StatusOr<SharedSynthesizer> LoadOne(const ModelChoice& choice) {
  const engine::PipelineOptions options{choice.as_served, choice.as_served, choice.as_served};
  if (!choice.embedded)
    return Share(torch_engine::LoadTorchSynthesizer(choice.checkpoint, options));
  absl::StatusOr<std::vector<std::unique_ptr<engine::Synthesizer>>> all =
      torch_engine::LoadEmbeddedSynthesizers(options);
  if (!all.ok()) return all.status();
  return SharedSynthesizer(std::move(all->front()));
}

}  // namespace

absl::StatusOr<NamedRuns> ParseRuns(const std::string& text) {
  const size_t equals = text.find('=');
  NamedRuns runs{text.substr(0, equals), text};
  if (equals == std::string::npos) {
    // "runs/" ends in an empty part.
    const fs::path path = (fs::path(text) / "").parent_path();
    runs.name = path.lexically_normal().filename().string();
  } else {
    runs.folder = text.substr(equals + 1);
  }
  if (!runs.name.empty() && !runs.folder.empty()) return runs;
  return absl::InvalidArgumentError(
      absl::StrCat("--runs: expected NAME=DIR or DIR, got ", base::Quoted(text)));
}

absl::StatusOr<checkpoint::Checkpoint> ReadRunCheckpoint(const fs::path& run) {
  absl::StatusOr<fs::path> folder = FindCheckpoint(run);
  if (!folder.ok()) return folder.status();
  return checkpoint::ReadCheckpoint(*folder);
}

absl::StatusOr<SharedSynthesizer> LoadFoldModel(const fs::path& runs, const std::string& subject,
                                                bool as_served) {
  absl::StatusOr<checkpoint::Checkpoint> checkpoint = ReadRunCheckpoint(runs / subject);
  if (!checkpoint.ok()) return checkpoint.status();
  return Share(torch_engine::MakeTorchSynthesizer(*checkpoint, {as_served, as_served, as_served}));
}

absl::StatusOr<std::vector<FoldModel>> OpenModels(const ModelChoice& choice) {
  std::vector<FoldModel> models;
  if (choice.one_for_all()) {
    absl::StatusOr<SharedSynthesizer> one = LoadOne(choice);
    if (!one.ok()) return one.status();
    models.push_back({"duet", [one](const std::string&) { return one; }});
  }
  for (const std::string& text : choice.runs) {
    absl::StatusOr<NamedRuns> runs = ParseRuns(text);
    if (!runs.ok()) return runs.status();
    const bool as_served = choice.as_served;
    models.push_back({runs->name, [runs = *runs, as_served](const std::string& subject) {
                        return LoadFoldModel(runs.folder, subject, as_served);
                      }});
  }
  return models;
}

}  // namespace duet::evaluation::program

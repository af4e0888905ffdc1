#include "model/evaluation/program/models.h"

#include <utility>

#include "model/evaluation/program/fold_models.h"
#include "model/evaluation/program/named_runs.h"
#include "model/torch_engine/torch_synthesizer.h"

namespace duet::evaluation::program {
namespace {

using SharedSynthesizer = std::shared_ptr<const engine::Synthesizer>;

absl::StatusOr<SharedSynthesizer> LoadOne(const ModelChoice& choice) {
  const engine::PipelineOptions options{choice.as_served, choice.as_served, choice.as_served};
  if (choice.embedded) {
    absl::StatusOr<std::vector<std::unique_ptr<engine::Synthesizer>>> all =
        torch_engine::LoadEmbeddedSynthesizers(options);
    if (!all.ok()) return all.status();
    return SharedSynthesizer(std::move(all->front()));
  }
  absl::StatusOr<std::unique_ptr<engine::Synthesizer>> one =
      torch_engine::LoadTorchSynthesizer(choice.checkpoint, options);
  if (!one.ok()) return one.status();
  return SharedSynthesizer(*std::move(one));
}

}  // namespace

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

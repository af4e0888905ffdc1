#include "model/evaluation/program/model_tables.h"

#include <utility>
#include <vector>

namespace duet::evaluation::program {

absl::Status FinishModelTables(const SectionFlags& flags, const ModelChoice& models,
                               const MeasureModel& measure, report::ResultSection section) {
  absl::StatusOr<std::vector<FoldModel>> opened = OpenModels(models);
  if (!opened.ok()) return opened.status();
  for (const FoldModel& model : *opened) {
    absl::StatusOr<SharedSynthesizer> synthesizer = model.load("");
    if (!synthesizer.ok()) return synthesizer.status();
    absl::StatusOr<report::Table> table = measure(model.name, **synthesizer);
    if (!table.ok()) return table.status();
    section.tables.push_back(*std::move(table));
  }
  return FinishSection(flags, section);
}

}  // namespace duet::evaluation::program

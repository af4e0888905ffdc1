#ifndef DUET_MODEL_EVALUATION_PROGRAM_MODEL_TABLES_H_
#define DUET_MODEL_EVALUATION_PROGRAM_MODEL_TABLES_H_

#include <functional>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "model/evaluation/program/models.h"
#include "model/evaluation/program/section_flags.h"
#include "model/evaluation/report/result_section.h"

namespace duet::evaluation::program {

// Measures one model, which has this name in the tables.
using MeasureModel = std::function<absl::StatusOr<report::Table>(const std::string& name,
                                                                 const engine::Synthesizer& model)>;

// Adds a table for each model of the command line, loaded without a fold, and finishes the section.
// Errors: those of OpenModels, of loading a model, of `measure` and of FinishSection.
absl::Status FinishModelTables(const SectionFlags& flags, const ModelChoice& models,
                               const MeasureModel& measure, report::ResultSection section);

}  // namespace duet::evaluation::program

#endif  // DUET_MODEL_EVALUATION_PROGRAM_MODEL_TABLES_H_

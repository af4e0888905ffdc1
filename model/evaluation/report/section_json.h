#ifndef DUET_MODEL_EVALUATION_REPORT_SECTION_JSON_H_
#define DUET_MODEL_EVALUATION_REPORT_SECTION_JSON_H_

#include <string>

#include "absl/status/statusor.h"
#include "model/evaluation/report/result_section.h"

namespace duet::evaluation::report {

// A section as JSON, all but its figures' SVG documents, which have files of their own.
std::string SectionToJson(const ResultSection& section);

// Strict: what SectionToJson writes, and nothing else. Errors: INVALID_ARGUMENT naming the field.
absl::StatusOr<ResultSection> SectionFromJson(const std::string& text);

}  // namespace duet::evaluation::report

#endif  // DUET_MODEL_EVALUATION_REPORT_SECTION_JSON_H_

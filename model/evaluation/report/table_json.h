#ifndef DUET_MODEL_EVALUATION_REPORT_TABLE_JSON_H_
#define DUET_MODEL_EVALUATION_REPORT_TABLE_JSON_H_

#include <nlohmann/json.hpp>
#include <string>

#include "absl/status/statusor.h"
#include "model/evaluation/report/table.h"

namespace duet::evaluation::report {

// A table as JSON. A missing figure is null; an infinite one, which JSON has no number for, becomes
// a string that TableFromJson refuses by name.
nlohmann::ordered_json TableToJson(const Table& table);

// Strict. `path` names the table in messages. Errors: INVALID_ARGUMENT naming the field.
absl::StatusOr<Table> TableFromJson(const nlohmann::json& value, const std::string& path);

}  // namespace duet::evaluation::report

#endif  // DUET_MODEL_EVALUATION_REPORT_TABLE_JSON_H_

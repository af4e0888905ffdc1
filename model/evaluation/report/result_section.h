#ifndef DUET_MODEL_EVALUATION_REPORT_RESULT_SECTION_H_
#define DUET_MODEL_EVALUATION_REPORT_RESULT_SECTION_H_

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "model/evaluation/report/table.h"

// The data of figures. scripts/make_report.py draws them.

namespace duet::evaluation::report {

struct ResultFigure {
  std::string name;     // of its files, lower_snake_case, unique within the report
  std::string caption;  // one or two sentences
  // Values that are not finite are null. The field "kind" is "latent" (latent_command.cc) or
  // "poses" (plausible_command.cc).
  nlohmann::ordered_json plot;
};

// The results of one duet-eval command, as the report prints them.
struct ResultSection {
  std::string id;                 // lower_snake_case; names the file and orders the report
  std::string title;              // a heading
  std::vector<std::string> text;  // paragraphs before the tables
  std::vector<Table> tables;
  std::vector<ResultFigure> figures;
  // What produced it, in order: data, folds, seeds, sizes, hashes of the judges.
  std::vector<std::pair<std::string, std::string>> settings;
  std::string command;  // reproduces the section; folders are placeholders
  std::string date;     // YYYY-MM-DD
};

// Writes <folder>/<id>.json, whole or not at all.
// Errors: INVALID_ARGUMENT naming the field for an id or a figure's name that is not 1 to 64 of
// a-z, 0-9 and _, a repeated name, an infinite value.
absl::Status WriteSection(const ResultSection& section, const std::filesystem::path& folder);

// Today, YYYY-MM-DD, in UTC.
std::string Today();

}  // namespace duet::evaluation::report

#endif  // DUET_MODEL_EVALUATION_REPORT_RESULT_SECTION_H_

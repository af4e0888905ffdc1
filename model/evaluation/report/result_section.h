#ifndef DUET_MODEL_EVALUATION_REPORT_RESULT_SECTION_H_
#define DUET_MODEL_EVALUATION_REPORT_RESULT_SECTION_H_

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "model/evaluation/report/table.h"

namespace duet::evaluation::report {

// A figure of a report: one SVG document.
struct ResultFigure {
  std::string name;     // of its file, lower_snake_case, unique within the report
  std::string caption;  // one or two sentences
  std::string svg;
};

// What one command of duet-eval found, as the report prints it.
struct ResultSection {
  std::string id;                 // lower_snake_case; of its file, and its place in the report
  std::string title;              // a heading
  std::vector<std::string> text;  // paragraphs before the tables
  std::vector<Table> tables;
  std::vector<ResultFigure> figures;
  // What produced it, in order: data, folds, seeds, sizes, extractor hashes.
  std::vector<std::pair<std::string, std::string>> settings;
  std::string command;  // to make it again, with DIR for the data's folder
  std::string date;     // YYYY-MM-DD
};

// Writes <folder>/<id>.json and <folder>/<figure>.svg, each whole or not at all.
absl::Status WriteSection(const ResultSection& section, const std::filesystem::path& folder);

// Reads every section of a folder, sorted by id. Strict. Errors: NOT_FOUND without any;
// INVALID_ARGUMENT naming file and field.
absl::StatusOr<std::vector<ResultSection>> ReadSections(const std::filesystem::path& folder);

// Today, YYYY-MM-DD, in UTC.
std::string Today();

}  // namespace duet::evaluation::report

#endif  // DUET_MODEL_EVALUATION_REPORT_RESULT_SECTION_H_

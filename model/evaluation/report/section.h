#ifndef DUET_MODEL_EVALUATION_REPORT_SECTION_H_
#define DUET_MODEL_EVALUATION_REPORT_SECTION_H_

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"

// What duet-eval prints and writes: tables, and the sections that scripts/make_report.py reads.

namespace duet::evaluation::report {

struct TableRow {
  std::string name;
  std::vector<double> values;  // one per column; NaN: no figure
  // True for figures that the paper prints and that were not measured here: the row is shown
  // separately and never marked as best.
  bool printed = false;
};

// Which figures of a column are marked as its best.
enum class Best { kNone, kLowest, kHighest };

// Figures by method (rows) and class (columns).
struct Table {
  std::string title;
  std::vector<std::string> columns = {};
  std::vector<TableRow> rows = {};
  std::vector<std::string> notes = {};  // printed below, one line each
  int decimals = 2;
  Best best = Best::kNone;
};

// The mean of each column, ignoring NaN. Shapes: rows [rows][columns]; returns [columns].
std::vector<double> ColumnMeans(const std::vector<std::vector<double>>& rows);

// Adds a last column "mean" with each row's mean; NaN where a figure is missing.
void AddMeanColumn(Table* table);

// A table for a terminal: figures rounded to `decimals`, a dash for a missing one, an asterisk at
// every figure that is printed like the best one of its column. Every row has one value per column.
std::string ToPlainText(const Table& table);

struct Figure {
  std::string name;     // of its files, lower_snake_case, unique within the report
  std::string caption;  // one or two sentences
  // What scripts/make_report.py draws. Values that are not finite are null.
  nlohmann::ordered_json plot;
};

// The results of one duet-eval command.
struct Section {
  std::string id;                      // lower_snake_case; names the file and orders the report
  std::string title;                   // a heading
  std::vector<std::string> text = {};  // paragraphs before the tables
  std::vector<Table> tables = {};
  std::vector<Figure> figures = {};
  // What produced it, in order: data, folds.
  std::vector<std::pair<std::string, std::string>> settings = {};
  std::string command;  // reproduces the section; folders are placeholders
};

// Writes <folder>/<id>.json with today's date, whole or not at all.
absl::Status WriteSection(const Section& section, const std::filesystem::path& folder);

}  // namespace duet::evaluation::report

#endif  // DUET_MODEL_EVALUATION_REPORT_SECTION_H_

#ifndef DUET_MODEL_EVALUATION_REPORT_TABLE_H_
#define DUET_MODEL_EVALUATION_REPORT_TABLE_H_

#include <string>
#include <vector>

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

}  // namespace duet::evaluation::report

#endif  // DUET_MODEL_EVALUATION_REPORT_TABLE_H_

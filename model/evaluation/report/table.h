#ifndef DUET_MODEL_EVALUATION_REPORT_TABLE_H_
#define DUET_MODEL_EVALUATION_REPORT_TABLE_H_

#include <string>
#include <vector>

namespace duet::evaluation::report {

struct TableRow {
  std::string name;
  std::vector<double> values;  // one a column; NaN: no figure
  // True for figures that the paper prints and that were not measured here: the row is set apart
  // and never marked as best.
  bool printed = false;
};

// Which figures of a column are marked as its best.
enum class Best { kNone, kLowest, kHighest };

// Figures by method (rows) and class (columns).
struct Table {
  std::string title;
  std::vector<std::string> columns;
  std::vector<TableRow> rows;
  std::vector<std::string> notes;  // printed below, one line each
  int decimals = 2;
  Best best = Best::kNone;
};

// Adds a last column "mean" with each row's mean; NaN where a figure is missing.
void AddMeanColumn(Table* table);

// A figure as it is printed.
struct TableCell {
  std::string text;   // rounded; a dash for a missing figure
  bool best = false;  // ties are all best
};
// Shapes: returns [rows][columns].
std::vector<std::vector<TableCell>> FormatCells(const Table& table);

// A table in four formats. Every row has as many values as there are columns.
// Plain text and Markdown round figures to `decimals`, print a dash for a missing one, and mark
// every figure that is printed like the best one of its column. CSV and JSON keep enough digits to
// read the same number back; a missing figure is an empty field in CSV and null in JSON.
std::string ToPlainText(const Table& table);  // marked with an asterisk
std::string ToMarkdown(const Table& table);   // marked in bold
std::string ToCsv(const Table& table);        // RFC 4180; a column "printed" tells the rows apart
std::string ToJson(const Table& table);

}  // namespace duet::evaluation::report

#endif  // DUET_MODEL_EVALUATION_REPORT_TABLE_H_

#ifndef DUET_MODEL_EVALUATION_REPORT_TABLE_H_
#define DUET_MODEL_EVALUATION_REPORT_TABLE_H_

#include <string>
#include <vector>

namespace duet::evaluation::report {

struct TableRow {
  std::string name;
  std::vector<double> values;  // one a column; NaN: no figure
  // A row that was not measured here (the paper's printed figures): set apart, never marked as
  // best.
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

// The table in each form. Every row has as many values as there are columns. Figures are rounded to
// `decimals`, but in CSV and JSON, which keep what is needed to read the same number back; a
// missing figure is a dash, in CSV an empty field, in JSON null. Plain text and Markdown mark the
// best figures as they are printed: ties are all marked.
std::string ToPlainText(const Table& table);  // marked with an asterisk
std::string ToMarkdown(const Table& table);   // marked in bold
std::string ToCsv(const Table& table);        // RFC 4180; a column "printed" tells the rows apart
std::string ToJson(const Table& table);

}  // namespace duet::evaluation::report

#endif  // DUET_MODEL_EVALUATION_REPORT_TABLE_H_

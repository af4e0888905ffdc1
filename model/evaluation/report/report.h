#ifndef DUET_MODEL_EVALUATION_REPORT_REPORT_H_
#define DUET_MODEL_EVALUATION_REPORT_REPORT_H_

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"

namespace duet::evaluation::report {

// What duet-eval prints and writes: tables, and the sections that scripts/make_report.py reads.

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

// A figure of each column. Shapes: rows [rows][columns]; returns [columns].
template <typename Figure>
std::vector<double> OverColumns(const std::vector<std::vector<double>>& rows, Figure figure) {
  std::vector<double> figures;
  for (size_t c = 0; !rows.empty() && c < rows.front().size(); ++c) {
    std::vector<double> values;
    for (const std::vector<double>& row : rows) values.push_back(row[c]);
    figures.push_back(figure(values));
  }
  return figures;
}
// The means, ignoring NaN.
std::vector<double> ColumnMeans(const std::vector<std::vector<double>>& rows);

// Adds a last column "mean" with each row's mean; NaN where a figure is missing.
void AddMeanColumn(Table* table);

// A table for a terminal: figures rounded to `decimals`, a dash for a missing one. Every row has
// one value per column.
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

inline constexpr char kAccuracy[] = "accuracy";
inline constexpr char kFrechet[] = "fid";
inline constexpr char kDiversity[] = "diversity";

// How a figure is printed.
struct MetricStyle {
  std::string name;   // lower_snake_case; ScoreMotion's for the figures of single motions
  std::string title;  // of its table
  int decimals = 2;
  Best best = Best::kNone;
  bool of_captured = false;  // meaningful for captured followers by themselves
  bool judged = false;       // needs a classifier
};

// Every figure of the tables: those of ScoreMotion, then the judge's.
const std::vector<MetricStyle>& MetricStyles();

// Figures of one method, or of the captured followers, by metric.
struct MethodFigures {
  std::string name;
  bool captured = false;
  std::map<std::string, std::vector<double>> by_metric;  // [classes] each
};

// One row per method, one column per class and their mean. Omits methods without the figure, and
// captured followers if it has no meaning for them.
Table MetricTable(const MetricStyle& style, const std::vector<std::string>& classes,
                  const std::vector<MethodFigures>& methods);

// Adds the paper's rows and notes below those measured here, if the paper's columns are the table's
// classes; otherwise adds a note that they are not. `table` ends in a mean column.
void AddPrintedRows(const Table& paper, Table* table);

// Figures of a model's many answers, beside those of MetricStyles.
inline constexpr char kMeanAnswerAfd[] = "afd_of_mean";
inline constexpr char kBestAnswerAfd[] = "afd_of_best";
inline constexpr char kMultimodality[] = "multimodality";
inline constexpr char kFilteredDiversity[] = "filtered_diversity";
// Of all classes together: one value.
inline constexpr char kPooledFrechet[] = "fid_pooled";
inline constexpr char kFilteredFrechet[] = "fid_pooled_filtered";

// One row per method, every figure the mean over the classes; speed and range of motion as ratios
// to the captured followers, of class means. Requires these as the first row, with both figures.
Table SampleSummary(const std::vector<MethodFigures>& methods);

// The figures printed by Goel et al. 2022. Every row is marked as printed; a note of each table
// says what it is comparable with. Columns have this project's class names.

Table PaperAfdSbu();        // Tables 1 and 4: average frame distance on SBU
Table PaperFidSbu();        // Table 2
Table PaperAugmentation();  // Table 6: a classifier's accuracy without and with synthetic motion

}  // namespace duet::evaluation::report

#endif  // DUET_MODEL_EVALUATION_REPORT_REPORT_H_

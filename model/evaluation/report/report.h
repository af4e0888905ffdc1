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

// Figures of each column. Shapes: rows [rows][columns]; returns [columns].
// The means, ignoring NaN.
std::vector<double> ColumnMeans(const std::vector<std::vector<double>>& rows);
// The standard deviations with divisor n - 1.
std::vector<double> ColumnDeviations(const std::vector<std::vector<double>>& rows);

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

inline constexpr char kCaptured[] = "captured";  // the row of the captured followers
inline constexpr char kAccuracy[] = "accuracy";
inline constexpr char kFrechet[] = "fid";
inline constexpr char kDiversity[] = "diversity";

// How a figure is printed.
struct MetricStyle {
  std::string name;   // lower_snake_case; ScoreMotion's for the figures of single motions
  std::string title;  // of its table
  int decimals = 2;
  Best best = Best::kNone;
  std::string note = {};  // below its table
  bool judged = false;    // needs a classifier
};

// Every figure of the tables: those of ScoreMotion, then the judge's.
const std::vector<MetricStyle>& MetricStyles();

// Figures of one method, or of the captured followers, by metric.
struct MethodFigures {
  std::string name;
  std::map<std::string, std::vector<double>> by_metric;  // [classes] each
};

// One row per method, one column per class and their mean, NaN where a figure is missing. Omits
// methods without the figure, and captured followers in tables of errors, whose lowest is best.
Table MetricTable(const MetricStyle& style, const std::vector<std::string>& classes,
                  const std::vector<MethodFigures>& methods);

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

}  // namespace duet::evaluation::report

#endif  // DUET_MODEL_EVALUATION_REPORT_REPORT_H_

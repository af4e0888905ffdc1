#ifndef DUET_MODEL_EVALUATION_REPORT_METRIC_TABLES_H_
#define DUET_MODEL_EVALUATION_REPORT_METRIC_TABLES_H_

#include <map>
#include <string>
#include <vector>

#include "model/evaluation/report/table.h"

namespace duet::evaluation::report {

inline constexpr char kAccuracy[] = "accuracy";
inline constexpr char kFrechet[] = "fid";
inline constexpr char kDiversity[] = "diversity";

// How a figure is printed.
struct MetricStyle {
  std::string name;   // lower_snake_case; MetricName's for the figures of single motions
  std::string title;  // of its table
  int decimals = 2;
  Best best = Best::kNone;
  bool judged = false;       // needs a classifier
  bool of_captured = false;  // meaningful for captured followers by themselves
};

// Every figure of the tables: those of AllMetrics, then the judge's.
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

}  // namespace duet::evaluation::report

#endif  // DUET_MODEL_EVALUATION_REPORT_METRIC_TABLES_H_

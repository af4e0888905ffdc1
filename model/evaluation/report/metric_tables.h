#ifndef DUET_MODEL_EVALUATION_REPORT_METRIC_TABLES_H_
#define DUET_MODEL_EVALUATION_REPORT_METRIC_TABLES_H_

#include <map>
#include <string>
#include <vector>

#include "model/evaluation/report/section.h"

namespace duet::evaluation::report {

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

#endif  // DUET_MODEL_EVALUATION_REPORT_METRIC_TABLES_H_

#ifndef DUET_MODEL_EVALUATION_REPORT_SAMPLE_TABLES_H_
#define DUET_MODEL_EVALUATION_REPORT_SAMPLE_TABLES_H_

#include <string>
#include <vector>

#include "model/evaluation/report/metric_tables.h"
#include "model/evaluation/report/table.h"

namespace duet::evaluation::report {

// Figures of a model's many answers, beside those of MetricStyles, by class.
inline constexpr char kMeanAnswerAfd[] = "afd_of_mean";
inline constexpr char kMeanAnswerAfdMetres[] = "afd_of_mean_m";
inline constexpr char kBestAnswerAfd[] = "afd_of_best";
inline constexpr char kBestAnswerAfdMetres[] = "afd_of_best_m";
inline constexpr char kMultimodality[] = "multimodality";
inline constexpr char kFilteredDiversity[] = "filtered_diversity";
// Of all classes together: one value.
inline constexpr char kPooledFrechet[] = "fid_pooled";
inline constexpr char kFilteredFrechet[] = "fid_pooled_filtered";

// One row per name: rows with the same name (a model trained with several seeds) become their mean.
// In order of first appearance.
std::vector<MethodFigures> MeanByName(const std::vector<MethodFigures>& rows);

// One row per method, every figure the mean over the classes; speed and range of motion as ratios
// to the row of captured followers, of class means. Requires that row.
Table SampleSummary(const std::vector<MethodFigures>& methods);

// The standard deviations (n - 1) of the summary's figures over the rows of each name that occurs
// more than once.
Table SampleSpread(const std::vector<MethodFigures>& methods);

// By class: the ratios and every figure of MetricStyles and of the above.
std::vector<Table> SampleTables(const std::vector<std::string>& classes,
                                const std::vector<MethodFigures>& methods);

}  // namespace duet::evaluation::report

#endif  // DUET_MODEL_EVALUATION_REPORT_SAMPLE_TABLES_H_

#ifndef DUET_MODEL_EVALUATION_EXPERIMENTS_ESTIMATE_H_
#define DUET_MODEL_EVALUATION_EXPERIMENTS_ESTIMATE_H_

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "model/evaluation/report/table.h"

namespace duet::evaluation::experiments {

// A figure and its 95 % interval.
struct Estimate {
  double value = 0, low = 0, high = 0;
};

// A figure of some of the rows of a measurement, which may be repeated. NaN: it has no value.
using Statistic = std::function<double(const std::vector<size_t>& rows)>;

// The statistic of all rows, and its interval by the bootstrap: leaders are drawn with all their
// rows, because the answers to one leader are alike. The same input gives the same result.
// Shapes: leaders [rows].
Estimate Bootstrap(const std::vector<int>& leaders, const Statistic& statistic);

// The same for the mean of the values that are not NaN. Shapes: both [rows].
Estimate BootstrapMean(const std::vector<int>& leaders, const std::vector<double>& values);

// NaN for a denominator of 0.
double Ratio(double numerator, double denominator);

// Pearson's correlation; 0 if either side is constant. Shapes: both [samples].
double Correlation(const std::vector<double>& a, const std::vector<double>& b);

// A table with three columns for each variant: its figure, and both ends of its interval.
report::Table EstimateTable(const std::string& title, const std::vector<std::string>& variants);
// Shapes: estimates [variants].
void AddEstimates(const std::string& name, const std::vector<Estimate>& estimates,
                  report::Table* table);

}  // namespace duet::evaluation::experiments

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_ESTIMATE_H_

#include "model/evaluation/experiments/estimate.h"

#include <cmath>
#include <map>
#include <numeric>

#include "model/base/random.h"
#include "model/base/statistics.h"

namespace duet::evaluation::experiments {
namespace {

constexpr int kResamples = 400;
constexpr double kLowShare = 0.025, kHighShare = 0.975;

// A series with a smaller deviation has no correlation with another.
constexpr double kConstant = 1e-9;

}  // namespace

Estimate Bootstrap(const std::vector<int>& leaders, const Statistic& statistic) {
  std::vector<size_t> all(leaders.size());
  std::iota(all.begin(), all.end(), size_t{0});
  std::map<int, std::vector<size_t>> rows_of;
  for (const size_t row : all) rows_of[leaders[row]].push_back(row);
  std::vector<const std::vector<size_t>*> groups;
  for (const auto& [leader, rows] : rows_of) groups.push_back(&rows);
  base::Random random(0);
  std::vector<double> values;
  for (int n = 0; n < kResamples && !groups.empty(); ++n) {
    std::vector<size_t> drawn;
    for (size_t i = 0; i < groups.size(); ++i) {
      const auto& rows =
          *groups[static_cast<size_t>(random.Below(static_cast<int64_t>(groups.size())))];
      drawn.insert(drawn.end(), rows.begin(), rows.end());
    }
    const double value = statistic(drawn);
    if (!std::isnan(value)) values.push_back(value);
  }
  return {statistic(all), base::Quantile(values, kLowShare), base::Quantile(values, kHighShare)};
}

Estimate BootstrapMean(const std::vector<int>& leaders, const std::vector<double>& values) {
  return Bootstrap(leaders, [&values](const std::vector<size_t>& rows) {
    std::vector<double> some;
    for (const size_t row : rows) some.push_back(values[row]);
    return base::Mean(some);
  });
}

double Ratio(double numerator, double denominator) {
  return denominator == 0 ? NAN : numerator / denominator;
}

double Correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const double mean_a = base::Mean(a), mean_b = base::Mean(b);
  double product = 0, square_a = 0, square_b = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    product += (a[i] - mean_a) * (b[i] - mean_b);
    square_a += std::pow(a[i] - mean_a, 2);
    square_b += std::pow(b[i] - mean_b, 2);
  }
  const double scale = std::sqrt(square_a * square_b);
  return scale > kConstant ? product / scale : 0;
}

report::Table EstimateTable(const std::string& title, const std::vector<std::string>& variants) {
  report::Table table{title};
  for (const std::string& variant : variants) {
    table.columns.insert(table.columns.end(), {variant, "low", "high"});
  }
  table.decimals = 3;
  return table;
}

void AddEstimates(const std::string& name, const std::vector<Estimate>& estimates,
                  report::Table* table) {
  report::TableRow row{name, {}};
  for (const Estimate& estimate : estimates) {
    row.values.insert(row.values.end(), {estimate.value, estimate.low, estimate.high});
  }
  table->rows.push_back(std::move(row));
}

}  // namespace duet::evaluation::experiments

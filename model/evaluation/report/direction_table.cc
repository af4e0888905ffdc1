#include "model/evaluation/report/direction_table.h"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace duet::evaluation::report {
namespace {

double Quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const double at = share * static_cast<double>(values.size() - 1);
  const std::size_t below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (at - static_cast<double>(below)) * (values[above] - values[below]);
}

}  // namespace

Table DirectionTable(const std::vector<DirectionRow>& rows) {
  Table table;
  table.title = "Where the partner is expected: degrees off";
  table.columns = {"tests", "median", "90th percentile"};
  table.notes = {
      "Hips: where the leader's hips face in the first frame. A model: its own estimate from the "
      "leader's motion, or the hips if it has none."};
  table.decimals = 1;
  for (const DirectionRow& row : rows) {
    table.rows.push_back({row.name,
                          {static_cast<double>(row.errors.size()), Quantile(row.errors, 0.5),
                           Quantile(row.errors, 0.9)}});
  }
  return table;
}

}  // namespace duet::evaluation::report

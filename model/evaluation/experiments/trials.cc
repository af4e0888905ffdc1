#include "model/evaluation/experiments/trials.h"

#include <algorithm>
#include <limits>

#include "model/base/statistics.h"

namespace duet::evaluation::experiments {
namespace {

double ShareAboveZero(const std::vector<double>& values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto above = std::count_if(values.begin(), values.end(), [](double v) { return v > 0; });
  return static_cast<double>(above) / static_cast<double>(values.size());
}

using Row = std::map<std::string, std::vector<double>>;  // by trial

std::vector<double> Column(const Row& row, size_t column) {
  std::vector<double> values;
  for (const auto& [trial, figures] : row) values.push_back(figures[column]);
  return values;
}

Row Differences(const Row& row, const Row& base) {
  Row differences;
  for (const auto& [trial, figures] : row) {
    const auto found = base.find(trial);
    if (found == base.end()) continue;
    std::vector<double>& out = differences[trial];
    for (size_t c = 0; c < figures.size(); ++c) out.push_back(figures[c] - found->second[c]);
  }
  return differences;
}

}  // namespace

void Trials::Add(const std::string& row, const std::string& trial, std::vector<double> values) {
  auto found =
      std::find_if(rows_.begin(), rows_.end(), [&](const auto& one) { return one.first == row; });
  if (found == rows_.end()) found = rows_.insert(rows_.end(), {row, {}});
  found->second[trial] = std::move(values);
}

TrialSummary Trials::Summary(const std::string& name, const Row& row) const {
  TrialSummary summary;
  summary.row = name;
  for (size_t c = 0; c < columns_.size(); ++c) {
    const std::vector<double> values = Column(row, c);
    const auto [mean, deviation] = base::Summarise(values);
    summary.means.push_back(mean);
    summary.deviations.push_back(deviation);
    summary.above_zero.push_back(ShareAboveZero(values));
  }
  return summary;
}

std::vector<TrialSummary> Trials::Summaries() const {
  std::vector<TrialSummary> summaries;
  for (const auto& [name, row] : rows_) summaries.push_back(Summary(name, row));
  return summaries;
}

std::vector<TrialSummary> Trials::Gains(const std::string& base) const {
  const auto found =
      std::find_if(rows_.begin(), rows_.end(), [&](const auto& one) { return one.first == base; });
  if (found == rows_.end()) return {};
  std::vector<TrialSummary> gains;
  for (const auto& [name, row] : rows_) {
    if (name != base) gains.push_back(Summary(name, Differences(row, found->second)));
  }
  return gains;
}

}  // namespace duet::evaluation::experiments

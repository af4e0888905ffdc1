#include "model/evaluation/experiments/trials.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace duet::evaluation::experiments {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
constexpr int kDecimals = 3;

double ShareAboveZero(const std::vector<double>& values) {
  if (values.empty()) return kMissing;
  const auto above = std::count_if(values.begin(), values.end(), [](double v) { return v > 0; });
  return static_cast<double>(above) / static_cast<double>(values.size());
}

report::Table EmptyTable(std::string title, const std::vector<std::string>& columns) {
  report::Table table;
  table.title = std::move(title);
  table.columns = columns;
  table.decimals = kDecimals;
  return table;
}

}  // namespace

MeanAndDeviation Summarise(const std::vector<double>& values) {
  const double count = static_cast<double>(values.size());
  if (values.empty()) return {kMissing, kMissing};
  double sum = 0, squares = 0;
  for (const double value : values) sum += value;
  const double mean = sum / count;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return {mean, values.size() < 2 ? kMissing : std::sqrt(squares / (count - 1))};
}

void Trials::Add(const std::string& row, const std::string& trial, std::vector<double> values) {
  auto found =
      std::find_if(rows_.begin(), rows_.end(), [&](const auto& one) { return one.first == row; });
  if (found == rows_.end()) found = rows_.insert(rows_.end(), {row, {}});
  found->second[trial] = std::move(values);
}

std::vector<double> Trials::Column(const Row& row, size_t column) const {
  std::vector<double> values;
  for (const auto& [trial, figures] : row) values.push_back(figures[column]);
  return values;
}

Trials::Row Trials::Differences(const Row& row, const Row& base) const {
  Row differences;
  for (const auto& [trial, figures] : row) {
    const auto found = base.find(trial);
    if (found == base.end()) continue;
    std::vector<double>& out = differences[trial];
    for (size_t c = 0; c < figures.size(); ++c) out.push_back(figures[c] - found->second[c]);
  }
  return differences;
}

report::Table Trials::Means(std::string title) const {
  report::Table table = EmptyTable(std::move(title), columns_);
  table.best = report::Best::kHighest;
  for (const auto& [name, row] : rows_) {
    table.rows.push_back({name, {}});
    for (size_t c = 0; c < columns_.size(); ++c) {
      table.rows.back().values.push_back(Summarise(Column(row, c)).mean);
    }
  }
  return table;
}

report::Table Trials::Deviations(std::string title) const {
  report::Table table = EmptyTable(std::move(title), columns_);
  for (const auto& [name, row] : rows_) {
    table.rows.push_back({name, {}});
    for (size_t c = 0; c < columns_.size(); ++c) {
      table.rows.back().values.push_back(Summarise(Column(row, c)).deviation);
    }
  }
  return table;
}

report::Table Trials::Gains(const std::string& base, std::string title) const {
  report::Table table = EmptyTable(std::move(title), columns_);
  const auto found =
      std::find_if(rows_.begin(), rows_.end(), [&](const auto& one) { return one.first == base; });
  if (found == rows_.end()) return table;
  for (const auto& [name, row] : rows_) {
    if (name == base) continue;
    const Row differences = Differences(row, found->second);
    report::TableRow mean{name, {}}, deviation{name + ", deviation", {}},
        share{name + ", share above 0", {}};
    for (size_t c = 0; c < columns_.size(); ++c) {
      const std::vector<double> values = Column(differences, c);
      const MeanAndDeviation summary = Summarise(values);
      mean.values.push_back(summary.mean);
      deviation.values.push_back(summary.deviation);
      share.values.push_back(ShareAboveZero(values));
    }
    for (report::TableRow* one : {&mean, &deviation, &share}) table.rows.push_back(std::move(*one));
  }
  return table;
}

}  // namespace duet::evaluation::experiments

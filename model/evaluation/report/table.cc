#include "model/evaluation/report/table.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "absl/strings/str_format.h"
#include "model/base/statistics.h"

namespace duet::evaluation::report {
namespace {

constexpr char kDash[] = "-";

std::string Rounded(double value, int decimals) {
  if (std::isnan(value)) return kDash;
  const std::string rounded = absl::StrFormat("%.*f", decimals, value);
  // Never "-0.00".
  const bool is_zero = rounded.find_first_of("123456789in") == std::string::npos;
  return is_zero && rounded[0] == '-' ? rounded.substr(1) : rounded;
}

// The best of a column among the rows measured here, as printed; empty if there is none.
std::string BestOf(const Table& table, size_t column) {
  double best = std::numeric_limits<double>::quiet_NaN();
  for (const TableRow& row : table.rows) {
    const double value = row.values[column];
    if (row.printed || std::isnan(value)) continue;
    const bool better = table.best == Best::kLowest ? value < best : value > best;
    if (std::isnan(best) || better) best = value;
  }
  if (table.best == Best::kNone || std::isnan(best)) return "";
  return Rounded(best, table.decimals);
}

// Characters, not bytes: names may hold more than ASCII.
size_t Width(const std::string& text) {
  return static_cast<size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

// The spaces that bring a text to a width.
std::string Padding(const std::string& text, size_t width) {
  return std::string(width - std::min(width, Width(text)), ' ');
}

}  // namespace

std::vector<double> ColumnMeans(const std::vector<std::vector<double>>& rows) {
  std::vector<double> means;
  for (size_t c = 0; !rows.empty() && c < rows.front().size(); ++c) {
    std::vector<double> values;
    for (const std::vector<double>& row : rows) values.push_back(row[c]);
    means.push_back(base::Mean(values));
  }
  return means;
}

void AddMeanColumn(Table* table) {
  table->columns.push_back("mean");
  for (TableRow& row : table->rows) row.values.push_back(base::Summarise(row.values).mean);
}

std::string ToPlainText(const Table& table) {
  std::vector<std::vector<std::string>> lines = {{""}};
  lines[0].insert(lines[0].end(), table.columns.begin(), table.columns.end());
  for (const TableRow& row : table.rows) lines.push_back({row.name});
  for (size_t column = 0; column < table.columns.size(); ++column) {
    const std::string best = BestOf(table, column);
    for (size_t i = 0; i < table.rows.size(); ++i) {
      const std::string text = Rounded(table.rows[i].values[column], table.decimals);
      lines[i + 1].push_back((text == best && !table.rows[i].printed ? "*" : "") + text);
    }
  }
  std::vector<size_t> widths(lines[0].size());
  for (const std::vector<std::string>& line : lines) {
    for (size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], Width(line[i]));
  }
  std::string text = table.title + '\n';
  for (const std::vector<std::string>& line : lines) {
    text += line[0] + Padding(line[0], widths[0]);
    for (size_t i = 1; i < line.size(); ++i) text += "  " + Padding(line[i], widths[i]) + line[i];
    text += '\n';
  }
  for (const std::string& note : table.notes) text += "  " + note + '\n';
  return text;
}

}  // namespace duet::evaluation::report

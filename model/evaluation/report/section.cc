#include "model/evaluation/report/section.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <system_error>

#include "absl/strings/str_format.h"
#include "absl/time/clock.h"
#include "absl/time/time.h"
#include "model/base/file.h"
#include "model/base/statistics.h"

namespace duet::evaluation::report {
namespace {

using nlohmann::ordered_json;

std::string Rounded(double value, int decimals) {
  return std::isnan(value) ? "-" : absl::StrFormat("%.*f", decimals, value);
}

// The best of a column among the rows measured here, as printed; empty if there is none.
std::string BestOf(const Table& table, size_t column) {
  double best = NAN;
  for (const TableRow& row : table.rows) {
    if (row.printed) continue;
    const double value = row.values[column];  // fmin and fmax ignore NaN
    best = table.best == Best::kLowest ? std::fmin(best, value) : std::fmax(best, value);
  }
  return table.best == Best::kNone || std::isnan(best) ? "" : Rounded(best, table.decimals);
}

constexpr const char* kBestNames[] = {"none", "lowest", "highest"};  // as in Best

// NaN becomes null.
ordered_json ToJson(const Table& table) {
  ordered_json rows = ordered_json::array();
  for (const TableRow& row : table.rows) {
    rows.push_back({{"name", row.name}, {"printed", row.printed}, {"values", row.values}});
  }
  return {{"title", table.title},       {"columns", table.columns},
          {"rows", std::move(rows)},    {"notes", table.notes},
          {"decimals", table.decimals}, {"best", kBestNames[static_cast<size_t>(table.best)]}};
}

ordered_json ToJson(const Section& section) {
  ordered_json tables = ordered_json::array(), figures = tables, settings = tables;
  for (const Table& table : section.tables) tables.push_back(ToJson(table));
  for (const Figure& figure : section.figures) {
    figures.push_back({{"name", figure.name}, {"caption", figure.caption}, {"plot", figure.plot}});
  }
  for (const auto& [name, value] : section.settings) {
    settings.push_back({{"name", name}, {"value", value}});
  }
  return {{"format_version", 1},
          {"id", section.id},
          {"title", section.title},
          {"text", section.text},
          {"tables", std::move(tables)},
          {"figures", std::move(figures)},
          {"settings", std::move(settings)},
          {"command", section.command},
          {"date", absl::FormatTime("%Y-%m-%d", absl::Now(), absl::UTCTimeZone())}};
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
    for (size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  }
  std::string text = table.title + '\n';
  for (const std::vector<std::string>& line : lines) {
    text += absl::StrFormat("%-*s", static_cast<int>(widths[0]), line[0]);
    for (size_t i = 1; i < line.size(); ++i) {
      text += absl::StrFormat("  %*s", static_cast<int>(widths[i]), line[i]);
    }
    text += '\n';
  }
  for (const std::string& note : table.notes) text += "  " + note + '\n';
  return text;
}

absl::Status WriteSection(const Section& section, const std::filesystem::path& folder) {
  std::error_code error;  // base::WriteFile reports a folder that cannot be made
  std::filesystem::create_directories(folder, error);
  const std::string text =
      ToJson(section).dump(1, ' ', false, ordered_json::error_handler_t::replace);
  return base::WriteFile(folder / (section.id + ".json"), text + '\n');
}

}  // namespace duet::evaluation::report

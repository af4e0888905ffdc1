#include "model/evaluation/table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>

#include "nlohmann/json.hpp"

namespace duet {
namespace {

constexpr char kDash[] = "-";

std::string Rounded(double value, int decimals) {
  if (std::isnan(value)) return kDash;
  char text[64];
  std::snprintf(text, sizeof(text), "%.*f", decimals, value);
  return text;
}

// The shortest form that reads back as the same number; empty for a missing one.
std::string Exact(double value) {
  if (std::isnan(value)) return "";
  char text[32];
  const std::to_chars_result end = std::to_chars(text, text + sizeof(text), value);
  return std::string(text, end.ptr);
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

// The figures of every row as text, the best ones between the marks.
std::vector<std::vector<std::string>> Cells(const Table& table, const std::string& before,
                                            const std::string& after) {
  std::vector<std::vector<std::string>> cells(table.rows.size());
  for (size_t column = 0; column < table.columns.size(); ++column) {
    const std::string best = BestOf(table, column);
    for (size_t i = 0; i < table.rows.size(); ++i) {
      std::string cell = Rounded(table.rows[i].values[column], table.decimals);
      if (cell == best && !table.rows[i].printed) cell = before + cell + after;
      cells[i].push_back(std::move(cell));
    }
  }
  return cells;
}

std::string PadLeft(const std::string& text, size_t width) {
  return std::string(width > text.size() ? width - text.size() : 0, ' ') + text;
}

std::string PadRight(const std::string& text, size_t width) {
  return text + std::string(width > text.size() ? width - text.size() : 0, ' ');
}

std::string EscapeMarkdown(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '|' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

std::string EscapeCsv(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + '"';
}

}  // namespace

void AddMeanColumn(Table* table) {
  table->columns.push_back("mean");
  for (TableRow& row : table->rows) {
    double sum = 0;
    for (const double value : row.values) sum += value;
    row.values.push_back(sum / static_cast<double>(row.values.size()));
  }
}

std::string ToPlainText(const Table& table) {
  const std::vector<std::vector<std::string>> cells = Cells(table, "*", "");
  size_t name_width = 0;
  for (const TableRow& row : table.rows) name_width = std::max(name_width, row.name.size());
  std::string text = table.title + "\n" + std::string(name_width, ' ');
  std::vector<size_t> widths;
  for (size_t column = 0; column < table.columns.size(); ++column) {
    size_t width = table.columns[column].size();
    for (const auto& row : cells) width = std::max(width, row[column].size());
    widths.push_back(width);
    text += "  " + PadLeft(table.columns[column], width);
  }
  text += '\n';
  for (size_t i = 0; i < table.rows.size(); ++i) {
    text += PadRight(table.rows[i].name, name_width);
    for (size_t column = 0; column < widths.size(); ++column) {
      text += "  " + PadLeft(cells[i][column], widths[column]);
    }
    text += '\n';
  }
  for (const std::string& note : table.notes) text += "  " + note + '\n';
  return text;
}

std::string ToMarkdown(const Table& table) {
  const std::vector<std::vector<std::string>> cells = Cells(table, "**", "**");
  std::string text = "**" + EscapeMarkdown(table.title) + "**\n\n| |";
  std::string rule = "|---|";
  for (const std::string& column : table.columns) {
    text += ' ' + EscapeMarkdown(column) + " |";
    rule += "---:|";
  }
  text += '\n' + rule + '\n';
  for (size_t i = 0; i < table.rows.size(); ++i) {
    const std::string name = EscapeMarkdown(table.rows[i].name);
    text += table.rows[i].printed ? "| *" + name + "* |" : "| " + name + " |";
    for (const std::string& cell : cells[i]) text += ' ' + cell + " |";
    text += '\n';
  }
  for (const std::string& note : table.notes) text += "\n" + note + '\n';
  return text;
}

std::string ToCsv(const Table& table) {
  std::string text = "row,printed";
  for (const std::string& column : table.columns) text += ',' + EscapeCsv(column);
  text += '\n';
  for (const TableRow& row : table.rows) {
    text += EscapeCsv(row.name) + (row.printed ? ",true" : ",false");
    for (const double value : row.values) text += ',' + Exact(value);
    text += '\n';
  }
  return text;
}

std::string ToJson(const Table& table) {
  nlohmann::ordered_json json = {
      {"title", table.title}, {"columns", table.columns}, {"notes", table.notes}};
  json["rows"] = nlohmann::ordered_json::array();
  for (const TableRow& row : table.rows) {
    nlohmann::ordered_json values = nlohmann::ordered_json::array();
    for (const double value : row.values) {
      values.push_back(std::isnan(value) ? nlohmann::ordered_json()
                                         : nlohmann::ordered_json(value));
    }
    json["rows"].push_back({{"name", row.name}, {"printed", row.printed}, {"values", values}});
  }
  return json.dump(2) + '\n';
}

}  // namespace duet

#include "model/evaluation/report/table_json.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "model/base/strict_json.h"
#include "model/base/text.h"

namespace duet::evaluation::report {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr size_t kMaxRows = 1000;
constexpr size_t kMaxColumns = 100;
constexpr size_t kMaxNotes = 100;
constexpr size_t kMaxTextBytes = 4096;
constexpr int kMaxDecimals = 12;
constexpr std::array<const char*, 3> kBestNames = {"none", "lowest", "highest"};  // as in Best

ordered_json FigureToJson(double value) {
  if (std::isnan(value)) return nullptr;
  if (std::isinf(value)) return value > 0 ? "infinite" : "-infinite";
  return value;
}

Best ReadBest(base::ObjectReader* reader) {
  const std::string name = reader->String("best", kMaxTextBytes);
  const auto found = std::find(kBestNames.begin(), kBestNames.end(), name);
  if (found != kBestNames.end()) return static_cast<Best>(found - kBestNames.begin());
  reader->Fail("best",
               absl::StrCat(base::Quoted(name), R"(, wanted "none", "lowest" or "highest")"));
  return Best::kNone;
}

std::vector<double> ReadFigures(base::ObjectReader* reader, size_t columns) {
  std::vector<double> figures;
  for (const json& value : reader->Array("values", kMaxColumns)) {
    if (!value.is_null() && !value.is_number()) {
      reader->Fail(absl::StrCat("values[", figures.size(), "]"),
                   absl::StrCat(value.type_name(), ", wanted a number or null"));
    }
    figures.push_back(value.is_number() ? value.get<double>()
                                        : std::numeric_limits<double>::quiet_NaN());
  }
  if (figures.size() != columns) {
    reader->Fail("values", absl::StrCat(figures.size(), " came, wanted one for each of the ",
                                        columns, " columns"));
  }
  return figures;
}

}  // namespace

ordered_json TableToJson(const Table& table) {
  ordered_json rows = ordered_json::array();
  for (const TableRow& row : table.rows) {
    ordered_json values = ordered_json::array();
    for (const double value : row.values) values.push_back(FigureToJson(value));
    rows.push_back({{"name", row.name}, {"printed", row.printed}, {"values", std::move(values)}});
  }
  return {{"title", table.title},       {"columns", table.columns},
          {"rows", std::move(rows)},    {"notes", table.notes},
          {"decimals", table.decimals}, {"best", kBestNames.at(static_cast<size_t>(table.best))}};
}

absl::StatusOr<Table> TableFromJson(const json& value, const std::string& path) {
  base::ObjectReader reader(value, path);
  Table table;
  table.title = reader.String("title", kMaxTextBytes);
  table.columns = reader.Strings("columns", kMaxColumns);
  for (const json& item : reader.Array("rows", kMaxRows)) {
    base::ObjectReader fields(item, absl::StrCat(path, ".rows[", table.rows.size(), "]"));
    TableRow row;
    row.name = fields.String("name", kMaxTextBytes);
    row.printed = fields.Bool("printed");
    row.values = ReadFigures(&fields, table.columns.size());
    reader.Update(fields.Finish());
    table.rows.push_back(std::move(row));
  }
  table.notes = reader.Strings("notes", kMaxNotes);
  table.decimals = static_cast<int>(reader.Int("decimals", 0, kMaxDecimals));
  table.best = ReadBest(&reader);
  if (absl::Status status = reader.Finish(); !status.ok()) return status;
  return table;
}

std::string ToJson(const Table& table) {
  return TableToJson(table).dump(2, ' ', false, json::error_handler_t::replace) + '\n';
}

}  // namespace duet::evaluation::report

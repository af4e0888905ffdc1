#include "model/evaluation/report/section_json.h"

#include <algorithm>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/time/civil_time.h"
#include "model/base/strict_json.h"
#include "model/base/text.h"
#include "model/evaluation/report/table_json.h"

namespace duet::evaluation::report {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr int kFormatVersion = 1;
constexpr int kMaxDepth = 6;
constexpr size_t kMaxTextBytes = size_t{64} << 10;
constexpr size_t kMaxNameBytes = 64;
constexpr size_t kMaxItems = 1000;
constexpr char kWantedName[] = "1 to 64 of a-z, 0-9 and _";

bool IsName(const std::string& name) {
  return !name.empty() && name.size() <= kMaxNameBytes &&
         std::all_of(name.begin(), name.end(), [](unsigned char c) {
           return absl::ascii_islower(c) || absl::ascii_isdigit(c) || c == '_';
         });
}

std::string ReadName(base::ObjectReader* reader, const std::string& key) {
  std::string name = reader->String(key, kMaxTextBytes);
  if (reader->ok() && !IsName(name)) {
    reader->Fail(key, absl::StrCat(base::Quoted(name), ", wanted ", kWantedName));
  }
  return name;
}

std::string ReadDate(base::ObjectReader* reader) {
  std::string date = reader->String("date", kMaxTextBytes);
  absl::CivilDay day;
  const bool is_date = absl::ParseCivilTime(date, &day) && absl::FormatCivilTime(day) == date;
  if (reader->ok() && !is_date) {
    reader->Fail("date", absl::StrCat(base::Quoted(date), ", wanted YYYY-MM-DD"));
  }
  return date;
}

std::vector<Table> ReadTables(base::ObjectReader* reader) {
  std::vector<Table> tables;
  for (const json& item : reader->Array("tables", kMaxItems)) {
    absl::StatusOr<Table> table = TableFromJson(item, absl::StrCat("tables[", tables.size(), "]"));
    reader->Update(table.status());
    if (table.ok()) tables.push_back(*std::move(table));
  }
  return tables;
}

std::vector<ResultFigure> ReadFigures(base::ObjectReader* reader) {
  std::vector<ResultFigure> figures;
  std::set<std::string> seen;
  for (const json& item : reader->Array("figures", kMaxItems)) {
    base::ObjectReader fields(item, absl::StrCat("figures[", figures.size(), "]"));
    ResultFigure figure;
    figure.name = ReadName(&fields, "name");
    figure.caption = fields.String("caption", kMaxTextBytes);
    if (!seen.insert(figure.name).second)
      fields.Fail("name", base::Quoted(figure.name) + " is repeated");
    reader->Update(fields.Finish());
    figures.push_back(std::move(figure));
  }
  return figures;
}

std::vector<std::pair<std::string, std::string>> ReadSettings(base::ObjectReader* reader) {
  std::vector<std::pair<std::string, std::string>> settings;
  for (const json& item : reader->Array("settings", kMaxItems)) {
    base::ObjectReader fields(item, absl::StrCat("settings[", settings.size(), "]"));
    settings.emplace_back(fields.String("name", kMaxTextBytes),
                          fields.String("value", kMaxTextBytes));
    reader->Update(fields.Finish());
  }
  return settings;
}

}  // namespace

std::string SectionToJson(const ResultSection& section) {
  ordered_json tables = ordered_json::array();
  for (const Table& table : section.tables) tables.push_back(TableToJson(table));
  ordered_json figures = ordered_json::array();
  for (const ResultFigure& figure : section.figures) {
    figures.push_back({{"name", figure.name}, {"caption", figure.caption}});
  }
  ordered_json settings = ordered_json::array();
  for (const auto& [name, value] : section.settings) {
    settings.push_back({{"name", name}, {"value", value}});
  }
  const ordered_json whole = {{"format_version", kFormatVersion},
                              {"id", section.id},
                              {"title", section.title},
                              {"text", section.text},
                              {"tables", std::move(tables)},
                              {"figures", std::move(figures)},
                              {"settings", std::move(settings)},
                              {"command", section.command},
                              {"date", section.date}};
  return whole.dump(2, ' ', false, json::error_handler_t::replace) + '\n';
}

absl::StatusOr<ResultSection> SectionFromJson(const std::string& text) {
  const absl::StatusOr<json> whole = base::ParseStrictJson(text, kMaxDepth);
  if (!whole.ok()) return whole.status();
  base::ObjectReader reader(*whole, "");
  reader.Int("format_version", kFormatVersion, kFormatVersion);
  ResultSection section;
  section.id = ReadName(&reader, "id");
  section.title = reader.String("title", kMaxTextBytes);
  section.text = reader.Strings("text", kMaxItems);
  section.tables = ReadTables(&reader);
  section.figures = ReadFigures(&reader);
  section.settings = ReadSettings(&reader);
  section.command = reader.String("command", kMaxTextBytes);
  section.date = ReadDate(&reader);
  if (absl::Status status = reader.Finish(); !status.ok()) return status;
  return section;
}

}  // namespace duet::evaluation::report

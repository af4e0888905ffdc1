#include "model/evaluation/report/result_section.h"

#include <algorithm>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <system_error>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "absl/time/time.h"
#include "model/base/file.h"
#include "model/base/text.h"

namespace duet::evaluation::report {
namespace {

using nlohmann::ordered_json;

constexpr int kFormatVersion = 1;
constexpr size_t kMaxNameBytes = 64;
constexpr const char* kBestNames[] = {"none", "lowest", "highest"};  // as in Best

absl::Status CheckId(const std::string& name) {
  const bool is_name = !name.empty() && name.size() <= kMaxNameBytes &&
                       std::all_of(name.begin(), name.end(), [](unsigned char c) {
                         return absl::ascii_islower(c) || absl::ascii_isdigit(c) || c == '_';
                       });
  if (is_name) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrCat("id: expected 1 to 64 of a-z, 0-9 and _, got ", base::Quoted(name)));
}

// NaN becomes null.
ordered_json TableToJson(const Table& table) {
  ordered_json rows = ordered_json::array();
  for (const TableRow& row : table.rows) {
    rows.push_back({{"name", row.name}, {"printed", row.printed}, {"values", row.values}});
  }
  return {{"title", table.title},       {"columns", table.columns},
          {"rows", std::move(rows)},    {"notes", table.notes},
          {"decimals", table.decimals}, {"best", kBestNames[static_cast<size_t>(table.best)]}};
}

std::string SectionToJson(const ResultSection& section) {
  ordered_json tables = ordered_json::array();
  for (const Table& table : section.tables) tables.push_back(TableToJson(table));
  ordered_json figures = ordered_json::array();
  for (const ResultFigure& figure : section.figures) {
    figures.push_back({{"name", figure.name}, {"caption", figure.caption}, {"plot", figure.plot}});
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
  return whole.dump(1, ' ', false, ordered_json::error_handler_t::replace) + '\n';
}

}  // namespace

absl::Status WriteSection(const ResultSection& section, const std::filesystem::path& folder) {
  if (absl::Status status = CheckId(section.id); !status.ok()) return status;
  std::error_code error;  // base::WriteFile reports a folder that cannot be made
  std::filesystem::create_directories(folder, error);
  return base::WriteFile(folder / (section.id + ".json"), SectionToJson(section));
}

std::string Today() { return absl::FormatTime("%Y-%m-%d", absl::Now(), absl::UTCTimeZone()); }

}  // namespace duet::evaluation::report

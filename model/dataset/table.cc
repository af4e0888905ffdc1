#include "model/dataset/table.h"

#include <algorithm>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "model/base/text.h"

namespace duet::dataset {

const std::string& TableRow::operator[](const std::string& column) const {
  static const auto& none = *new std::string;
  const auto found = cells.find(column);
  return found == cells.end() ? none : found->second;
}

std::vector<std::string> TableRow::Names(const std::string& column) const {
  std::vector<std::string> names;
  for (absl::string_view name : absl::StrSplit((*this)[column], ',')) {
    name = absl::StripAsciiWhitespace(name);
    if (!name.empty()) names.emplace_back(name);
  }
  return names;
}

absl::StatusOr<std::vector<TableRow>> ReadTable(absl::string_view text, absl::string_view source,
                                                const std::vector<std::string>& required) {
  base::LineReader lines(base::SkipByteOrderMark(text));
  absl::string_view line;
  std::vector<std::string> columns;
  if (lines.Next(&line)) columns = absl::StrSplit(line, '\t');
  for (const std::string& column : required) {
    if (std::count(columns.begin(), columns.end(), column) > 0) continue;
    return base::ErrorAt(source, 1,
                         absl::StrCat("header: expected tab-separated names with ",
                                      absl::StrJoin(required, ", "), ", got no ", column));
  }
  std::vector<TableRow> rows;
  while (lines.Next(&line)) {
    if (absl::StripAsciiWhitespace(line).empty()) continue;
    std::vector<std::string> cells = absl::StrSplit(line, '\t');
    if (cells.size() != columns.size()) {
      return base::ErrorAt(
          source, lines.number(),
          absl::StrCat("columns: expected ", columns.size(), ", got ", cells.size()));
    }
    TableRow& row = rows.emplace_back();
    row.line = lines.number();
    for (size_t i = 0; i < cells.size(); ++i) row.cells[columns[i]] = std::move(cells[i]);
  }
  return rows;
}

}  // namespace duet::dataset

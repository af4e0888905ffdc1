#include "model/evaluation/report/html_table.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "model/evaluation/report/markup.h"

namespace duet::evaluation::report {
namespace {

// Long identifiers may break after an underscore.
std::string Name(const std::string& name) {
  return absl::StrReplaceAll(EscapeMarkup(name), {{"_", "_<wbr>"}});
}

void AppendRow(const TableRow& row, const std::vector<TableCell>& cells, std::string* out) {
  absl::StrAppend(out, "<tr><th scope=\"row\">", Name(row.name), "</th>");
  for (const TableCell& cell : cells) {
    if (cell.best) {
      absl::StrAppend(out, "<td class=\"best\"><b>", cell.text, "</b></td>");
    } else {
      absl::StrAppend(out, "<td>", cell.text == "-" ? "&ndash;" : cell.text, "</td>");
    }
  }
  *out += "</tr>\n";
}

// The rows that were measured here, or those that were not.
void AppendBody(const Table& table, bool printed, std::string* out) {
  const bool any = std::any_of(table.rows.begin(), table.rows.end(),
                               [&](const TableRow& row) { return row.printed == printed; });
  if (!any) return;
  *out += printed ? "<tbody class=\"printed\">\n" : "<tbody>\n";
  if (printed) {
    absl::StrAppend(out, "<tr class=\"group\"><th scope=\"rowgroup\" colspan=\"",
                    table.columns.size() + 1,
                    "\"><span>Printed in the paper, not measured here</span></th></tr>\n");
  }
  const std::vector<std::vector<TableCell>> cells = FormatCells(table);
  for (size_t i = 0; i < table.rows.size(); ++i) {
    if (table.rows[i].printed == printed) AppendRow(table.rows[i], cells[i], out);
  }
  *out += "</tbody>\n";
}

}  // namespace

std::string ToHtml(const Table& table, int number) {
  std::string out = absl::StrCat(
      "<figure class=\"table\">\n<figcaption><b>Table ", number, ".</b> ",
      EscapeMarkup(table.title),
      "</figcaption>\n<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Table ",
      number, "\">\n<table>\n<thead><tr><td></td>");
  for (const std::string& column : table.columns) {
    absl::StrAppend(&out, "<th scope=\"col\">", Name(column), "</th>");
  }
  out += "</tr></thead>\n";
  AppendBody(table, /*printed=*/false, &out);
  AppendBody(table, /*printed=*/true, &out);
  out += "</table>\n</div>\n";
  if (!table.notes.empty()) {
    out += "<div class=\"notes\">\n";
    for (const std::string& note : table.notes) {
      absl::StrAppend(&out, "<p>", EscapeMarkup(note), "</p>\n");
    }
    out += "</div>\n";
  }
  return out + "</figure>\n";
}

}  // namespace duet::evaluation::report

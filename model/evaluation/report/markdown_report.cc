#include "model/evaluation/report/markdown_report.h"

#include "absl/strings/str_cat.h"
#include "model/evaluation/report/markup.h"
#include "model/evaluation/report/table.h"

namespace duet::evaluation::report {
namespace {

// Numbers run through the whole report.
struct Counters {
  int tables = 0;
  int figures = 0;
};

void AppendTable(Table table, Counters* counters, std::string* out) {
  table.title = absl::StrCat("Table ", ++counters->tables, ". ", table.title);
  for (TableRow& row : table.rows) {
    if (row.printed) row.name += " (printed)";
  }
  absl::StrAppend(out, ToMarkdown(table), "\n");
}

void AppendFigure(const ResultFigure& figure, Counters* counters, std::string* out) {
  const std::string caption = EscapeMarkdown(figure.caption);
  absl::StrAppend(out, "![", caption, "](", figure.name, ".svg)\n\n*Figure ", ++counters->figures,
                  ". ", caption, "*\n\n");
}

// In HTML, which Markdown passes on: Markdown itself has no part that folds.
void AppendOrigin(const ResultSection& section, std::string* out) {
  absl::StrAppend(out, "<details><summary>Settings and command</summary>\n\n| | |\n|---|---|\n");
  for (const auto& [name, value] : section.settings) {
    absl::StrAppend(out, "| ", EscapeMarkdown(name), " | ", EscapeMarkdown(value), " |\n");
  }
  absl::StrAppend(out, "| date | ", section.date, " |\n\n<pre><code>",
                  EscapeMarkup(section.command), "</code></pre>\n\n</details>\n\n");
}

void AppendSection(const ResultSection& section, Counters* counters, std::string* out) {
  absl::StrAppend(out, "<a id=\"", section.id, "\"></a>\n\n## ", EscapeMarkdown(section.title),
                  "\n\n");
  for (const std::string& paragraph : section.text) {
    absl::StrAppend(out, EscapeMarkdown(paragraph), "\n\n");
  }
  for (const Table& table : section.tables) AppendTable(table, counters, out);
  for (const ResultFigure& figure : section.figures) AppendFigure(figure, counters, out);
  AppendOrigin(section, out);
}

}  // namespace

std::string ToMarkdown(const Report& report) {
  std::string out = absl::StrCat("# ", EscapeMarkdown(report.title), "\n\n", LatestDate(report),
                                 ". ", ReadingGuide(), "\n\n");
  for (const ResultSection& section : report.sections) {
    absl::StrAppend(&out, "- [", EscapeMarkdown(section.title), "](#", section.id, ")\n");
  }
  out += '\n';
  Counters counters;
  for (const ResultSection& section : report.sections) AppendSection(section, &counters, &out);
  out.pop_back();
  return out;
}

}  // namespace duet::evaluation::report

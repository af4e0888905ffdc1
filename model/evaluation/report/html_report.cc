#include "model/evaluation/report/html_report.h"

#include <cstddef>

#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "model/evaluation/report/html_table.h"
#include "model/evaluation/report/markup.h"

// Linked in by duet_embed_file.
extern "C" {
extern const char duet_report_style[], duet_report_style_end[];
}

namespace duet::evaluation::report {
namespace {

// Unfolds all settings before printing: they would be missing on paper.
constexpr char kPrintScript[] =
    "<script>addEventListener('beforeprint', () => "
    "document.querySelectorAll('details').forEach((d) => { d.open = true; }));</script>\n";

absl::string_view Style() {
  return {duet_report_style, static_cast<size_t>(duet_report_style_end - duet_report_style)};
}

void AppendFigure(const ResultFigure& figure, int number, std::string* out) {
  // The figure's own <svg> element, with its caption for those who cannot see it.
  constexpr absl::string_view kStart = "<svg ";
  absl::StrAppend(
      out,
      "<figure class=\"plot\">\n<div class=\"scroll\" tabindex=\"0\" role=\"region\" "
      "aria-label=\"Figure ",
      number, "\">\n", kStart, "role=\"img\" aria-label=\"", EscapeMarkup(figure.caption), "\" ",
      absl::string_view(figure.svg).substr(kStart.size()), "</div>\n<figcaption><b>Figure ", number,
      ".</b> ", EscapeMarkup(figure.caption), "</figcaption>\n</figure>\n");
}

void AppendOrigin(const ResultSection& section, std::string* out) {
  absl::StrAppend(out, "<details>\n<summary>Settings and command</summary>\n<dl>\n");
  for (const auto& [name, value] : section.settings) {
    absl::StrAppend(out, "<dt>", EscapeMarkup(name), "</dt><dd>", EscapeMarkup(value), "</dd>\n");
  }
  absl::StrAppend(out, "<dt>date</dt><dd>", section.date, "</dd>\n</dl>\n<pre><code>",
                  EscapeMarkup(section.command), "</code></pre>\n</details>\n");
}

void AppendSection(const ResultSection& section, int* tables, int* figures, std::string* out) {
  absl::StrAppend(out, "<section id=\"", section.id, "\">\n<h2>", EscapeMarkup(section.title),
                  "</h2>\n");
  for (const std::string& paragraph : section.text) {
    absl::StrAppend(out, "<p>", EscapeMarkup(paragraph), "</p>\n");
  }
  for (const Table& table : section.tables) *out += ToHtml(table, ++*tables);
  for (const ResultFigure& figure : section.figures) AppendFigure(figure, ++*figures, out);
  AppendOrigin(section, out);
  *out += "</section>\n";
}

void AppendContents(const Report& report, std::string* out) {
  *out += "<nav aria-label=\"Contents\">\n<h2>Contents</h2>\n<ol>\n";
  for (const ResultSection& section : report.sections) {
    absl::StrAppend(out, "<li><a href=\"#", section.id, "\">", EscapeMarkup(section.title),
                    "</a></li>\n");
  }
  *out += "</ol>\n</nav>\n";
}

}  // namespace

std::string ToHtml(const Report& report) {
  const std::string title = EscapeMarkup(report.title);
  std::string out = absl::StrCat(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n<title>",
      title, "</title>\n<style>\n", Style(), "</style>\n</head>\n<body>\n<header>\n<h1>", title,
      "</h1>\n<p class=\"date\">", LatestDate(report), "</p>\n<p>", EscapeMarkup(ReadingGuide()),
      "</p>\n</header>\n");
  AppendContents(report, &out);
  out += "<main>\n";
  int tables = 0, figures = 0;
  for (const ResultSection& section : report.sections) {
    AppendSection(section, &tables, &figures, &out);
  }
  return absl::StrCat(out, "</main>\n", kPrintScript, "</body>\n</html>\n");
}

}  // namespace duet::evaluation::report

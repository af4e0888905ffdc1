#include "model/evaluation/report/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "model/evaluation/report/html_report.h"
#include "model/evaluation/report/html_table.h"
#include "model/evaluation/report/markdown_report.h"
#include "model/evaluation/report/render_png.h"
#include "tests/evaluation/support/example_section.h"
#include "tests/support/status_matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::evaluation::report {
namespace {

using test::ExampleSection;
using test::IsOk;
using test::ReadTestFile;
using test::StatusIs;
using test::TemporaryFolder;
using test::WriteTestFile;

using testing::HasSubstr;
using testing::Not;

Report Example() {
  Report report = {"Figures & tables", {ExampleSection("10_folds"), ExampleSection("20_more")}};
  report.sections[1].title = "More";
  report.sections[1].date = "2024-03-01";
  return report;
}

TEST(HtmlTableTest, MarksTheBestAndSetsPrintedRowsApart) {
  EXPECT_EQ(ToHtml(ExampleSection("x").tables[0], 7),
            "<figure class=\"table\">\n"
            "<figcaption><b>Table 7.</b> Errors &lt;raw&gt; &amp; all</figcaption>\n"
            "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Table 7\">\n"
            "<table>\n"
            "<thead><tr><td></td><th scope=\"col\">kick</th>"
            "<th scope=\"col\">shake_<wbr>hands</th></tr></thead>\n"
            "<tbody>\n"
            "<tr><th scope=\"row\">ours</th><td class=\"best\"><b>0.504</b></td>"
            "<td class=\"best\"><b>0.333</b></td></tr>\n"
            "<tr><th scope=\"row\">frozen_<wbr>first_<wbr>frame</th><td>0.700</td>"
            "<td>&ndash;</td></tr>\n"
            "</tbody>\n"
            "<tbody class=\"printed\">\n"
            "<tr class=\"group\"><th scope=\"rowgroup\" colspan=\"3\">"
            "<span>Printed in the paper, not measured here</span></th></tr>\n"
            "<tr><th scope=\"row\">paper</th><td>0.100</td><td>0.200</td></tr>\n"
            "</tbody>\n"
            "</table>\n</div>\n"
            "<div class=\"notes\">\n<p>lower is better</p>\n</div>\n</figure>\n");
}

TEST(HtmlTableTest, HasNoEmptyGroups) {
  Table table = ExampleSection("x").tables[0];
  table.rows.erase(table.rows.begin() + 1);
  EXPECT_THAT(ToHtml(table, 1), Not(HasSubstr("Printed in the paper")));
  table.notes.clear();
  EXPECT_THAT(ToHtml(table, 1), Not(HasSubstr("class=\"notes\"")));
}

TEST(HtmlReportTest, IsOnePageThatNeedsNoOtherFile) {
  const std::string html = ToHtml(Example());
  EXPECT_EQ(html.rfind("<!DOCTYPE html>\n<html lang=\"en\">", 0), 0u);
  EXPECT_THAT(html, HasSubstr("<title>Figures &amp; tables</title>"));
  EXPECT_THAT(html, HasSubstr("prefers-color-scheme: dark")) << "the style is inside";
  EXPECT_THAT(html, HasSubstr("<path d=\"M0 0L9 9\"")) << "and the figures";
  for (const char* reference : {"src=", "<link", "url(", "@import"}) {
    EXPECT_THAT(html, Not(HasSubstr(reference)));
  }
}

TEST(HtmlReportTest, ContentsLeadToSections) {
  const std::string html = ToHtml(Example());
  EXPECT_THAT(html, HasSubstr("<li><a href=\"#10_folds\">Methods &amp; classes</a></li>\n"
                              "<li><a href=\"#20_more\">More</a></li>\n"));
  EXPECT_THAT(html, HasSubstr("<section id=\"20_more\">\n<h2>More</h2>\n"
                              "<p>First &lt;paragraph&gt;.</p>\n"));
  EXPECT_THAT(html, HasSubstr("<p class=\"date\">2024-03-01</p>")) << "the latest";
}

TEST(HtmlReportTest, NumbersRunThroughAllSections) {
  const std::string html = ToHtml(Example());
  EXPECT_LT(html.find("<b>Table 1.</b>"), html.find("<b>Table 2.</b>"));
  EXPECT_LT(html.find("<section id=\"20_more\">"), html.find("<b>Table 2.</b>"));
  EXPECT_THAT(html, HasSubstr("<b>Figure 2.</b> A curve of &quot;errors&quot;."));
}

TEST(HtmlReportTest, FiguresAreNamedAndOriginsFolded) {
  const std::string html = ToHtml(Example());
  EXPECT_THAT(html, HasSubstr("<svg role=\"img\" aria-label=\"A curve of &quot;errors&quot;.\" "
                              "xmlns="));
  EXPECT_THAT(html, HasSubstr("<details>\n<summary>Settings and command</summary>\n<dl>\n"
                              "<dt>data</dt><dd>SBU</dd>\n<dt>seeds</dt><dd>1, 2</dd>\n"
                              "<dt>date</dt><dd>2024-02-29</dd>\n</dl>\n"
                              "<pre><code>duet-eval folds --data DIR</code></pre>"));
}

TEST(MarkdownReportTest, SaysTheSame) {
  const std::string text = ToMarkdown(Example());
  EXPECT_EQ(text.rfind("# Figures & tables\n\n2024-03-01. The best figures", 0), 0u);
  EXPECT_THAT(text, HasSubstr("- [Methods & classes](#10_folds)\n- [More](#20_more)\n"));
  EXPECT_THAT(text, HasSubstr("<a id=\"20_more\"></a>\n\n## More\n\nFirst \\<paragraph\\>.\n\n"));
  EXPECT_THAT(text, HasSubstr("**Table 2. Errors \\<raw\\> & all**\n\n| | kick | shake_hands |\n"));
  EXPECT_THAT(text, HasSubstr("| ours | **0.504** | **0.333** |\n"
                              "| *paper (printed)* | 0.100 | 0.200 |\n"));
  EXPECT_THAT(text, HasSubstr("![A curve of \"errors\".](20_more_curve.svg)\n\n"
                              "*Figure 2. A curve of \"errors\".*\n"));
  EXPECT_THAT(text, HasSubstr("| seeds | 1, 2 |\n| date | 2024-03-01 |\n\n"
                              "<pre><code>duet-eval folds --data DIR</code></pre>"));
}

TEST(WriteReportTest, WritesPageTextAndFigures) {
  const TemporaryFolder folder;
  const Report report = Example();
  ASSERT_THAT(WriteReport(report, folder / "new/report"), IsOk());
  EXPECT_EQ(ReadTestFile(folder / "new/report/index.html"), ToHtml(report));
  EXPECT_EQ(ReadTestFile(folder / "new/report/report.md"), ToMarkdown(report));
  EXPECT_EQ(ReadTestFile(folder / "new/report/20_more_curve.svg"),
            report.sections[1].figures[0].svg);
}

TEST(WriteReportTest, SaysWhatCannotBeWritten) {
  const TemporaryFolder folder;
  WriteTestFile(folder / "file", "");
  EXPECT_THAT(WriteReport(Example(), folder / "file"),
              StatusIs(absl::StatusCode::kPermissionDenied, HasSubstr("10_folds_curve.svg")));
}

TEST(RenderPngTest, SaysWhenTheProgramIsMissing) {
  EXPECT_THAT(RenderPng("a.svg", "a.png", "no-such-program-7"),
              StatusIs(absl::StatusCode::kNotFound, "no-such-program-7 is not installed"));
}

TEST(RenderPngTest, RendersAt300DotsAnInch) {
  const TemporaryFolder folder;
  WriteTestFile(folder / "a.svg",
                "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"96\" height=\"48\"></svg>");
  ASSERT_THAT(RenderPng(folder / "a.svg", folder / "a.png"), IsOk());
  const std::string png = ReadTestFile(folder / "a.png");
  ASSERT_GT(png.size(), 24u);
  EXPECT_EQ(png.substr(1, 3), "PNG");
  // Width and height, big-endian, from byte 16 on.
  EXPECT_EQ(png.substr(16, 8), std::string("\0\0\1\x2C\0\0\0\x96", 8));
}

TEST(RenderPngTest, SaysWhichFigureFailed) {
  const TemporaryFolder folder;
  WriteTestFile(folder / "a.svg", "no picture");
  EXPECT_THAT(RenderPng(folder / "a.svg", folder / "a.png"),
              StatusIs(absl::StatusCode::kInternal, HasSubstr("a.svg: ended with status")));
}

}  // namespace
}  // namespace duet::evaluation::report

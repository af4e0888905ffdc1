#include "model/evaluation/report/markup.h"

#include <gtest/gtest.h>

namespace duet::evaluation::report {
namespace {

TEST(EscapeMarkupTest, EscapesWhatWouldBeMarkup) {
  EXPECT_EQ(EscapeMarkup("a<b & \"c\" > 'd'"), "a&lt;b &amp; &quot;c&quot; &gt; &#39;d&#39;");
  EXPECT_EQ(EscapeMarkup(std::string("one\n\x01two\0", 9)), "onetwo");
  EXPECT_EQ(EscapeMarkup("\u00b1 \u00e9"), "\u00b1 \u00e9");
}

TEST(EscapeMarkdownTest, EscapesWhatWouldBeMarkup) {
  EXPECT_EQ(EscapeMarkdown("a|b*c <d> [e] `f` #g \\ ~h"),
            "a\\|b\\*c \\<d\\> \\[e\\] \\`f\\` \\#g \\\\ \\~h");
  EXPECT_EQ(EscapeMarkdown("two\nlines"), "two lines");
}

TEST(EscapeMarkdownTest, KeepsUnderscoresWithinWords) {
  EXPECT_EQ(EscapeMarkdown("afd_squared_m"), "afd_squared_m");
  EXPECT_EQ(EscapeMarkdown("_important_ x_"), "\\_important\\_ x\\_");
}

TEST(EscapeCsvTest, QuotesOnlyWhatNeedsIt) {
  EXPECT_EQ(EscapeCsv("shake hands"), "shake hands");
  EXPECT_EQ(EscapeCsv("a,b"), "\"a,b\"");
  EXPECT_EQ(EscapeCsv("the \"own\" class"), "\"the \"\"own\"\" class\"");
  EXPECT_EQ(EscapeCsv("two\nlines"), "\"two\nlines\"");
}

}  // namespace
}  // namespace duet::evaluation::report

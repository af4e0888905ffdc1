#include "model/base/text.h"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "gmock/gmock.h"
#include "tests/support/matchers.h"

namespace duet::base {
namespace {

TEST(ParseNumber, AcceptsOneFiniteNumber) {
  double value = 0;
  EXPECT_TRUE(ParseNumber(" +1.5e3 ", &value));
  EXPECT_EQ(value, 1500);
  EXPECT_TRUE(ParseNumber("-.5", &value));
  EXPECT_EQ(value, -0.5);
  for (const char* text : {"", " ", "x", "1,5", "1 2", "1x", "+-1", "--1", "nan", "inf", "1e999"}) {
    EXPECT_FALSE(ParseNumber(text, &value)) << text;
  }
}

TEST(ParseInteger, AcceptsNineDigits) {
  int value = 0;
  EXPECT_TRUE(ParseInteger("-999999999", &value));
  EXPECT_EQ(value, -999'999'999);
  EXPECT_TRUE(ParseInteger("+7", &value));
  EXPECT_EQ(value, 7);
  for (const char* text : {"", "1000000000", "99999999999999999999", "1.0", "0x1", "1 2"}) {
    EXPECT_FALSE(ParseInteger(text, &value)) << text;
  }
}

std::string Number(float value) {
  std::string text;
  AppendNumber(&text, value);
  return text;
}

TEST(AppendNumber, WritesTheShortestTextThatReadsBack) {
  EXPECT_EQ(Number(0.1f), "0.1");
  EXPECT_EQ(Number(-3), "-3");
  const float odd = std::nextafter(1.0f, 2.0f);
  double back = 0;
  ASSERT_TRUE(ParseNumber(Number(odd), &back));
  EXPECT_EQ(static_cast<float>(back), odd);
}

std::string Fixed(double value, int decimals) {
  std::string text;
  AppendFixed(&text, value, decimals);
  return text;
}

TEST(AppendFixed, NeverWritesAMinusBeforeZero) {
  EXPECT_EQ(Fixed(-0.0001, 3), "0.000");
  EXPECT_EQ(Fixed(-0.0006, 3), "-0.001");
  EXPECT_EQ(Fixed(0.0, 0), "0");
  EXPECT_EQ(Fixed(std::numeric_limits<double>::max(), 3).size(), 313u);
}

TEST(ErrorAt, PointsAtAPlace) {
  EXPECT_EQ(ErrorAt("a.csv", 3, "no"), absl::InvalidArgumentError("a.csv:3: no"));
  EXPECT_EQ(ErrorAt("a.csv", 3, 7, "no"), absl::InvalidArgumentError("a.csv:3:7: no"));
}

TEST(ErrorAt, StaysAPrintableLineWhateverItQuotes) {
  EXPECT_EQ(ErrorAt("a.bvh", 3, "after a\rb").message(), "a.bvh:3: after a\\rb");
  EXPECT_EQ(ErrorAt("a.bvh", 3, 7, "after a\rb").message(), "a.bvh:3:7: after a\\rb");
  EXPECT_LT(ErrorAt("a.bvh", 3, std::string(100'000, 'x')).message().size(), 1100u);
}

TEST(SkipByteOrderMark, SkipsOnlyAByteOrderMark) {
  EXPECT_EQ(SkipByteOrderMark("\xEF\xBB\xBFx"), "x");
  EXPECT_EQ(SkipByteOrderMark("x\xEF\xBB\xBF"), "x\xEF\xBB\xBF");
}

TEST(LineReader, GivesLinesWithoutTheirEnds) {
  LineReader lines("a\r\n\nb\rc\nd");
  std::vector<std::string> read;
  for (absl::string_view line; lines.Next(&line);) read.emplace_back(line);
  EXPECT_THAT(read, ElementsAre("a", "", "b\rc", "d"));
  EXPECT_EQ(lines.number(), 4);
}

TEST(LineReader, CarriageReturnsAloneEndLines) {
  LineReader lines("a\r\rb\r");
  std::vector<std::string> read;
  for (absl::string_view line; lines.Next(&line);) read.emplace_back(line);
  EXPECT_THAT(read, ElementsAre("a", "", "b"));
}

TEST(Printable, EscapesBytesThatAreNotPrintableAscii) {
  EXPECT_EQ(Printable("no field \"c\"", 64), "no field \"c\"");
  EXPECT_EQ(Printable("a\nb\x7f\xff\r", 64), R"(a\nb\x7f\xff\r)");
  // Each byte alone: an escape swallows nothing that follows it.
  EXPECT_EQ(Printable("\x01"
                      "1",
                      64),
            R"(\x011)");
}

TEST(Printable, ShowsOnlyTheBeginningOfALongText) {
  EXPECT_EQ(Printable(std::string(8, 'x'), 8), "xxxxxxxx");
  EXPECT_EQ(Printable(std::string(9, 'x'), 8), "xxxxxxxx...");
}

TEST(EscapeControls, KeepsLettersOfEveryScript) {
  EXPECT_EQ(EscapeControls("\x1b[31mh\xc3\xbc"
                           "ftgelenk\x07\n\x7f"),
            "\\x1b[31mh\xc3\xbc"
            "ftgelenk\\x07\\n\\x7f");
}

}  // namespace
}  // namespace duet::base

#include "model/base/printable.h"

#include <gtest/gtest.h>

#include <string>

namespace duet::base {
namespace {

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

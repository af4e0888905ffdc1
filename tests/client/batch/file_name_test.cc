#include "client/batch/file_name.h"

#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"

namespace duet::client::batch {
namespace {

std::string Repeated(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

TEST(FitFileName, ShortNamesStayAsTheyAre) {
  for (const std::string& name :
       {std::string(), std::string("walks/a-2-kick"), std::string(200, 'x')}) {
    EXPECT_EQ(FitFileName(name), name);
  }
}

TEST(FitFileName, LongPartsAreTruncatedWithADigest) {
  const std::string fitting = FitFileName("walks/" + std::string(300, 'x') + "/a-kick");
  EXPECT_THAT(fitting, MatchesRegex("walks/x{120}_[0-9a-f]{16}/a-kick"));
  EXPECT_EQ(fitting, FitFileName("walks/" + std::string(300, 'x') + "/a-kick"));
  EXPECT_NE(fitting, FitFileName("walks/" + std::string(301, 'x') + "/a-kick"));
}

TEST(FitFileName, CharactersAreNotSplit) {
  // Two and three bytes a character.
  EXPECT_THAT(FitFileName("x" + Repeated("\xc3\xa9", 200)),
              StartsWith("x" + Repeated("\xc3\xa9", 59) + "_"));
  EXPECT_THAT(FitFileName("x" + Repeated("\xe6\xad\xa9", 200)),
              StartsWith("x" + Repeated("\xe6\xad\xa9", 39) + "_"));
}

TEST(FitFileName, PathsThatAreTooDeepBecomeOnePart) {
  const std::string fitting = FitFileName(Repeated("a/", 3000) + "b");
  EXPECT_THAT(fitting, MatchesRegex("(a_){60}_[0-9a-f]{16}"));
  EXPECT_NE(fitting, FitFileName(Repeated("a/", 3001) + "b"));
}

TEST(AsUtf8, ReplacesWhatIsNoCharacter) {
  const std::string valid = "caf\xc3\xa9 \xe6\xad\xa9 \xf0\x9f\x92\x83";
  EXPECT_EQ(AsUtf8(valid), valid);
  EXPECT_EQ(AsUtf8("caf\xe9"), "caf_");
  EXPECT_EQ(AsUtf8("\xe9t\xe9"), "_t_");
  EXPECT_EQ(AsUtf8("\xc0\xaf"), "__");            // longer than needed
  EXPECT_EQ(AsUtf8("\xed\xa0\x80"), "___");       // half of a UTF-16 pair
  EXPECT_EQ(AsUtf8("\xf4\x90\x80\x80"), "____");  // beyond the last character
  EXPECT_EQ(AsUtf8("\xe6\xad"), "__");            // cut short
}

}  // namespace
}  // namespace duet::client::batch

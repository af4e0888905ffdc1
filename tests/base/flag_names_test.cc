#include "model/base/flag_names.h"

#include <string>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace duet::base {
namespace {

using ::testing::ElementsAre;

// The words of a command line after it went through, the program's name first.
std::vector<std::string> Respelt(std::vector<const char*> words) {
  const KebabCaseCommandLine line(static_cast<int>(words.size()), words.data());
  EXPECT_EQ(line.argv()[line.argc()], nullptr);
  return {line.argv(), line.argv() + line.argc()};
}

TEST(KebabCaseCommandLineTest, FlagsInSnakeCaseAreRespelt) {
  EXPECT_THAT(Respelt({"program", "--version_number", "2", "--a_long_name"}),
              ElementsAre("program", "--version-number", "2", "--a-long-name"));
}

TEST(KebabCaseCommandLineTest, FlagsInKebabCaseStay) {
  EXPECT_THAT(Respelt({"program", "--version-number", "2", "--out"}),
              ElementsAre("program", "--version-number", "2", "--out"));
}

TEST(KebabCaseCommandLineTest, ValuesStay) {
  EXPECT_THAT(
      Respelt({"program", "class_mean", "--write_jobs=my_folder/a=b_c", "-a_b", "a--b_c"}),
      ElementsAre("program", "class_mean", "--write-jobs=my_folder/a=b_c", "-a_b", "a--b_c"));
}

TEST(KebabCaseCommandLineTest, WhatFollowsABareDoubleDashStays) {
  EXPECT_THAT(Respelt({"program", "--a_b", "--", "--c_d"}),
              ElementsAre("program", "--a-b", "--", "--c_d"));
}

TEST(KebabCaseCommandLineTest, TheProgramsNameStays) {
  EXPECT_THAT(Respelt({"--my_program"}), ElementsAre("--my_program"));
  EXPECT_THAT(Respelt({}), ElementsAre());
}

}  // namespace
}  // namespace duet::base

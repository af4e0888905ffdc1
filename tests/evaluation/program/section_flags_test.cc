#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "model/evaluation/program/flags.h"

namespace duet::evaluation::program {
namespace {

// The recorded form of a command line that is given without the program's name.
std::string Recorded(std::vector<std::string> words) {
  CLI::App app;
  CLI::App* command = app.add_subcommand("measure", "");
  std::string data;
  std::vector<std::string> subjects;
  SectionFlags section = {"10_measure", "Measured"};
  ModelChoice models;
  experiments::AskedSamples asked;
  AddDataFlag(&data, command);
  command->add_option("--subjects", subjects)->delimiter(',');
  AddSectionFlags(&section, command);
  std::string checked;
  command->add_option("--leaders", checked)->type_name(kData)->check(CLI::ExistingDirectory);
  AddModelFlags(ModelNeeded::kNo, &models, command);
  AddSamplingFlags(&asked, command);
  std::reverse(words.begin(), words.end());  // CLI11 takes the arguments in reverse
  app.parse(words);
  return RecordedCommand(*command);
}

TEST(RecordedCommandTest, FoldersAreReplacedByPlaceholders) {
  EXPECT_EQ(Recorded({"measure", "--data", "/home/me/sbu", "--out", "/tmp/results"}),
            "duet-eval measure --data DIR --out RESULTS");
  EXPECT_EQ(Recorded({"measure", "--data=x", "--checkpoint", "/models/sbu/2"}),
            "duet-eval measure --data DIR --checkpoint CHECKPOINT");
}

TEST(RecordedCommandTest, AFolderThatIsCheckedIsReplacedToo) {
  EXPECT_EQ(Recorded({"measure", "--data", "x", "--leaders", "/tmp"}),
            "duet-eval measure --data DIR --leaders DIR");
}

TEST(RecordedCommandTest, RunsKeepTheirNames) {
  EXPECT_EQ(Recorded({"measure", "--runs", "ours=/a/b", "--data", "x", "--runs", "/a/theirs/"}),
            "duet-eval measure --data DIR --runs ours=RUNS --runs theirs=RUNS");
}

TEST(RecordedCommandTest, OnlyFlagsThatWereGivenAreRecorded) {
  EXPECT_EQ(
      Recorded({"measure", "--subjects", "s01,s02", "--data", "x", "--as-served", "--seed", "7"}),
      "duet-eval measure --data DIR --subjects s01,s02 --as-served --seed 7");
}

TEST(RecordedCommandTest, ValuesAreQuotedForAShell) {
  EXPECT_EQ(Recorded({"measure", "--data", "x", "--title", "It's a sweep"}),
            "duet-eval measure --data DIR --title 'It'\\''s a sweep'");
}

}  // namespace
}  // namespace duet::evaluation::program

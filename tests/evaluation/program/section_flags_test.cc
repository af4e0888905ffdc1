#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "model/evaluation/program/experiment.h"

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

TEST(RecordedCommandTest, HasPlaceholdersForFoldersAndOnlyFlagsThatWereGiven) {
  const struct {
    std::vector<std::string> words;
    const char* recorded;
  } kCases[] = {
      {{"--data", "/home/me/sbu", "--out", "/tmp/results"}, "--data DIR --out RESULTS"},
      {{"--data=x", "--checkpoint", "/models/sbu/2"}, "--data DIR --checkpoint CHECKPOINT"},
      {{"--data", "x", "--leaders", "/tmp"}, "--data DIR --leaders DIR"},  // which is checked
      {{"--runs", "ours=/a/b", "--data", "x", "--runs", "/a/theirs/"},
       "--data DIR --runs ours=RUNS --runs theirs=RUNS"},
      {{"--subjects", "s01,s02", "--data", "x", "--as-served", "--seed", "7"},
       "--data DIR --subjects s01,s02 --as-served --seed 7"},
      {{"--data", "x", "--title", "It's a sweep"}, "--data DIR --title 'It'\\''s a sweep'"}};
  for (const auto& c : kCases) {
    std::vector<std::string> words = c.words;
    words.insert(words.begin(), "measure");
    EXPECT_EQ(Recorded(std::move(words)), std::string("duet-eval measure ") + c.recorded);
  }
}

}  // namespace
}  // namespace duet::evaluation::program

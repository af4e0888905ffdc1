// Everything that the program tells of itself.
#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "client/cli/command_line.h"
#include "client/cli/command_table.h"
#include "client/cli/help_topics.h"
#include "client/cli/program.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/formats/motion_file.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::client::cli {
namespace {

struct Printed {
  int exit_code = 0;
  std::string text;  // standard output and standard error
};

Printed Duet(const std::vector<std::string>& arguments) {
  std::ostringstream out, err;
  const int exit_code = RunProgram(arguments, {nullptr, &out, &err});
  return {exit_code, out.str() + err.str()};
}

TEST(Help, ExplainsCommandsAndTopics) {
  EXPECT_THAT(Duet({"help"}).text,
              AllOf(HasSubstr("Usage: duet [OPTIONS] SUBCOMMAND"),
                    HasSubstr("exit-codes, formats, joints, labels, settings")));
  EXPECT_THAT(Duet({"help", "convert"}).text, HasSubstr("Usage: duet convert"));
  EXPECT_EQ(Duet({"help", "convert"}).text, Duet({"convert", "--help"}).text);
  for (const std::string& topic : HelpTopics()) {
    const Printed printed = Duet({"help", topic});
    EXPECT_EQ(printed.exit_code, 0);
    EXPECT_THAT(printed.text, HasSubstr(".\n\n")) << topic;
  }
  EXPECT_THAT(Duet({"help", "settings"}).text, HasSubstr("DUET_SERVER"));
}

TEST(Help, ExamplesAreOfTheCommand) {
  for (const char* command :
       {"convert", "inspect", "synthesize", "live", "batch", "view", "admin"}) {
    EXPECT_THAT(Duet({"help", command}).text, HasSubstr(absl::StrCat("\n  duet ", command, " ")));
  }
}

TEST(Help, ListsReadableAndWritableFormats) {
  std::map<std::string, std::pair<bool, bool>> told;  // by extension
  for (absl::string_view line : absl::StrSplit(TopicText("formats"), '\n')) {
    if (!absl::StartsWith(line, "  .")) continue;
    // Columns begin where the table's head has them.
    const bool read = !absl::StartsWith(line.substr(15), "no ");
    const bool written = !absl::StartsWith(line.substr(37), "no ");
    for (absl::string_view extension : absl::StrSplit(line.substr(2, 12), ' ')) {
      if (!extension.empty()) told[std::string(extension)] = {read, written};
    }
  }
  for (const char* extension : {".gltf", ".glb", ".bvh", ".csv", ".json", ".npy", ".txt"}) {
    ASSERT_TRUE(told.count(extension)) << extension;
    const std::string file = absl::StrCat("a", extension);
    EXPECT_EQ(told[extension].first, formats::IsReadable(std::filesystem::path(file))) << extension;
    EXPECT_TRUE(told[extension].second) << extension;
  }
  EXPECT_EQ(told.size(), 7u);
}

TEST(Help, SuggestsTheNearestTopic) {
  const auto expect = [](const std::vector<std::string>& arguments, const char* text) {
    const Printed printed = Duet(arguments);
    EXPECT_EQ(printed.exit_code, 2);
    EXPECT_THAT(printed.text, HasSubstr(text));
  };
  expect({"sinthesize"}, "There is no command \"sinthesize\"; did you mean synthesize?");
  expect({"help", "lables"}, "did you mean labels?");
  expect({"help", "konvert"}, "did you mean convert?");
  expect({"man", "modls"}, "did you mean models?");
  expect({"models", "--sever", "x"}, "models has no flag --sever; did you mean --server?");
  expect({"models", "--sever=x"}, "models has no flag --sever; did you mean --server?");
  EXPECT_THAT(Duet({"models", "--xyzzy"}).text, Not(HasSubstr("did you mean")));
  // Whose value would be a third file.
  expect({"compare", "a", "b", "--page", "c"}, "compare has no flag --page\n");
  expect({"convert", "a", "--ou", "b"}, "convert has no flag --ou; did you mean --out?");
  expect({"batch", "merge", "--jsn"}, "batch has no flag --jsn; did you mean --json?");
}

TEST(Help, WorksWithInvalidSettings) {
  std::ostringstream out, err;
  ProgramEnvironment environment{nullptr, &out, &err};
  environment.variables = [](const std::string& name) {
    return name == "DUET_CONFIG" ? std::optional<std::string>("/nowhere/at/all") : std::nullopt;
  };
  EXPECT_EQ(RunProgram({"models"}, environment), 2);
  EXPECT_THAT(err.str(), HasSubstr("DUET_CONFIG: /nowhere/at/all: no such file"));
  for (const char* word : {"help", "--help", "--version", "man"}) {
    EXPECT_EQ(RunProgram({word}, environment), 0) << word;
  }
}

FlagEntry FlagOf(const CommandEntry& command, const std::string& name) {
  for (const FlagEntry& flag : command.flags) {
    if (flag.name == name) return flag;
  }
  ADD_FAILURE() << command.name << " has no " << name;
  return {};
}

TEST(CommandTable, ListsEveryCommandAndFlag) {
  const CommandLine line;
  const std::vector<CommandEntry> commands = ListCommands(line.app());
  std::vector<std::string> names;
  for (const CommandEntry& command : commands) names.push_back(command.name);
  EXPECT_THAT(names,
              ElementsAre("", "models", "synthesize", "live", "batch", "inspect", "convert", "view",
                          "compare", "admin", "admin models", "admin reload", "admin load",
                          "admin unload", "admin label", "stdio", "help", "completion", "man"));
  EXPECT_THAT(FlagOf(commands[2], "--leader-side").choices, ElementsAre("left", "right"));
  EXPECT_EQ(FlagOf(commands[2], "--leader-side").default_value, "left");
  EXPECT_TRUE(FlagOf(commands[2], "--leader").takes_file);
  EXPECT_TRUE(FlagOf(commands[2], "--leader").is_required);
  EXPECT_FALSE(FlagOf(commands[2], "--joint-map").takes_file);
  EXPECT_EQ(FlagOf(commands[2], "--quiet").form, "");
  EXPECT_THAT(FlagOf(commands[3], "--clean-up").choices, ElementsAre("auto", "off", "on"));
  EXPECT_TRUE(FlagOf(commands[3], "--from").is_required);
  EXPECT_TRUE(FlagOf(commands[7], "files").is_argument);
}

TEST(Completion, CompletesEveryFlag) {
  for (const char* shell : {"bash", "zsh", "fish"}) {
    const std::string script = Duet({"completion", shell}).text;
    EXPECT_THAT(script, AllOf(HasSubstr("joint-map-file"), HasSubstr("retries-per-item"),
                              HasSubstr("resample"), HasSubstr("left right")));
  }
  EXPECT_EQ(Duet({"completion", "tcsh"}).exit_code, 2);
}

TEST(ManualPage, HasTheContentOfHelp) {
  const std::string page = Duet({"man", "convert"}).text;
  EXPECT_THAT(page,
              AllOf(StartsWith(".TH DUET\\-CONVERT 1 "), HasSubstr(".SH SYNOPSIS"),
                    HasSubstr("\\fB\\-\\-resample\\fR \\fIHZ\\fR"), HasSubstr("(default: all)")));
  EXPECT_THAT(Duet({"man", "synthesize"}).text, HasSubstr("(default: left)"));
  EXPECT_THAT(Duet({"man"}).text,
              AllOf(StartsWith(".TH DUET 1 "), HasSubstr("\\fBduet\\-batch\\fR(1)\n"),
                    HasSubstr(".SH SETTINGS")));
}

TEST(ManualPage, EveryPageIsWrittenToAFolder) {
  const test::TemporaryFolder folder;
  std::ostringstream out, err;
  ASSERT_EQ(RunProgram({"man", "--out", (folder / "new/man1").string()}, {nullptr, &out, &err}), 0)
      << err.str();
  std::vector<std::string> names;
  for (const auto& file : std::filesystem::directory_iterator(folder / "new/man1")) {
    names.push_back(file.path().filename().string());
  }
  EXPECT_THAT(
      names, AllOf(Contains("duet.1"), Contains("duet-inspect.1"), Contains("duet-batch-merge.1")));
  EXPECT_EQ(names.size(), 21u);
}

}  // namespace
}  // namespace duet::client::cli

#include "client/cli/settings.h"

#include <map>
#include <string>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::client::cli {
namespace {

using test::TemporaryFolder;
using test::WriteTestFile;

constexpr auto kInvalid = absl::StatusCode::kInvalidArgument;

Variables Environment(const std::map<std::string, std::string>& variables) {
  return [variables](const std::string& name) {
    const auto found = variables.find(name);
    return found == variables.end() ? std::nullopt : std::optional<std::string>(found->second);
  };
}

// "name=value" of each.
std::vector<std::string> Read(const std::map<std::string, std::string>& variables) {
  const absl::StatusOr<std::vector<Setting>> settings = ReadSettings(Environment(variables));
  EXPECT_THAT(settings, IsOk());
  std::vector<std::string> texts;
  if (!settings.ok()) return texts;
  for (const Setting& setting : *settings) texts.push_back(setting.name + "=" + setting.value);
  return texts;
}

TEST(ParseSettings, ReadsFlagsWithoutDashes) {
  const auto settings = ParseSettings(
      "\xEF\xBB\xBF# ours\r\n\r\n  server = lab:50051 \nlabel=kick=1\nquiet =\n", "c");
  ASSERT_THAT(settings, IsOk());
  ASSERT_EQ(settings->size(), 3u);
  EXPECT_EQ((*settings)[0].name, "server");
  EXPECT_EQ((*settings)[0].value, "lab:50051");
  EXPECT_EQ((*settings)[0].source, "c:3");
  EXPECT_EQ((*settings)[1].value, "kick=1");
  EXPECT_EQ((*settings)[2].value, "");
}

TEST(ParseSettings, MalformedLineIsReportedWithItsNumber) {
  for (const char* line : {"server lab", "--server = lab", "= lab", "Server = lab", "a b = c"}) {
    EXPECT_THAT(ParseSettings(std::string("\n") + line + "\n", "config").status(),
                StatusIs(kInvalid, HasSubstr("config:2: expected FLAG = VALUE")))
        << line;
  }
}

class ReadSettingsTest : public ::testing::Test {
 protected:
  void Write(const std::string& name, const std::string& text) {
    std::filesystem::create_directories((folder_ / name).parent_path());
    WriteTestFile(folder_ / name, text);
  }
  std::string Path(const std::string& name) const { return (folder_ / name).string(); }

  TemporaryFolder folder_;
};

TEST_F(ReadSettingsTest, FileIsFoundInTheDefaultPlaces) {
  Write("home/.config/duet/config", "server = home:1\n");
  Write("xdg/duet/config", "server = xdg:1\n");
  Write("mine", "server = mine:1\n");
  EXPECT_THAT(Read({{"HOME", Path("home")}}), ElementsAre("server=home:1"));
  EXPECT_THAT(Read({{"HOME", Path("home")}, {"XDG_CONFIG_HOME", Path("xdg")}}),
              ElementsAre("server=xdg:1"));
  EXPECT_THAT(Read({{"XDG_CONFIG_HOME", Path("xdg")}, {"DUET_CONFIG", Path("mine")}}),
              ElementsAre("server=mine:1"));
}

TEST_F(ReadSettingsTest, FilesAreOptional) {
  EXPECT_TRUE(Read({}).empty());
  EXPECT_TRUE(Read({{"HOME", Path("nowhere")}}).empty());
  Write("home/.config/duet/config", "server = home:1\n");
  EXPECT_TRUE(Read({{"HOME", Path("home")}, {"DUET_CONFIG", ""}}).empty());
}

TEST_F(ReadSettingsTest, NamedFileMustExist) {
  EXPECT_THAT(ReadSettings(Environment({{"DUET_CONFIG", Path("no")}})).status(),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr("DUET_CONFIG: " + Path("no"))));
}

TEST_F(ReadSettingsTest, EnvironmentOverridesTheFile) {
  Write("c", "server = file:1\nserver = file:2\ntimeout = 3\n");
  EXPECT_THAT(Read({{"DUET_CONFIG", Path("c")}, {"DUET_SERVER", "variable:1"}}),
              ElementsAre("timeout=3", "server=variable:1"));
  EXPECT_THAT(Read({{"DUET_CONFIG", Path("c")}, {"DUET_SERVER", ""}}), ::testing::SizeIs(3));
}

}  // namespace
}  // namespace duet::client::cli

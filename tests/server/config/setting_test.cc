#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "server/config/load_config.h"
#include "server/config/settings.h"
#include "tests/support/matchers.h"

namespace duet::server::config {
namespace {

// A value that the flag of a setting accepts.
std::string SampleValue(const Setting& setting) {
  if (setting.name() == "version_labels") return "sbu:stable=3";
  switch (setting.field().cpp_type()) {
    case Setting::Field::CPPTYPE_ENUM:
      return ChoicesOf(*setting.field().enum_type()).front().flag_value;
    case Setting::Field::CPPTYPE_BOOL:
      return "true";
    default:
      return "1";
  }
}

// Whether the message has the field, and no other one.
bool HasOnly(const v1::ServerConfig& config, const Setting& setting) {
  std::vector<const Setting::Field*> fields;
  config.GetReflection()->ListFields(config, &fields);
  return fields.size() == 1 && fields[0] == &setting.field();
}

CommandLine Parse(const std::vector<std::string>& arguments, const Environment& environment) {
  std::vector<const char*> argv = {"duet-server"};
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  return ParseCommandLine(static_cast<int>(argv.size()), argv.data(), environment);
}

TEST(EverySettingTest, HasHelpAndAUnit) {
  std::set<std::string> flags;
  for (const Setting& setting : AllSettings()) {
    EXPECT_FALSE(setting.options().help().empty()) << setting.name();
    EXPECT_FALSE(absl::EndsWith(setting.options().help(), ".")) << setting.name();
    const bool has_value = setting.field().cpp_type() != Setting::Field::CPPTYPE_BOOL;
    EXPECT_EQ(!setting.unit().empty(), has_value) << setting.name();
    EXPECT_TRUE(flags.insert(setting.flag()).second) << setting.name();
  }
}

TEST(EverySettingTest, NumberHasARange) {
  for (const Setting& setting : AllSettings()) {
    const auto type = setting.field().cpp_type();
    const bool is_number = type == Setting::Field::CPPTYPE_UINT32 ||
                           type == Setting::Field::CPPTYPE_UINT64 ||
                           type == Setting::Field::CPPTYPE_DOUBLE;
    EXPECT_EQ(!setting.range_text().empty(), is_number) << setting.name();
  }
}

TEST(EverySettingTest, DefaultIsValid) {
  EXPECT_THAT(ReadSettings(v1::ServerConfig(), 4).mistakes, IsEmpty());
  for (const Setting& setting : AllSettings()) {
    if (setting.options().default_value().empty()) continue;
    v1::ServerConfig config;
    setting.SetDefault(&config);
    EXPECT_TRUE(HasOnly(config, setting)) << setting.name();
    EXPECT_THAT(ReadSettings(config, 4).mistakes, IsEmpty()) << setting.name();
  }
}

TEST(EverySettingTest, HasAFlagAndAVariable) {
  for (const Setting& setting : AllSettings()) {
    const std::string value = SampleValue(setting);
    const CommandLine flag = Parse({absl::StrCat("--", setting.flag(), "=", value)}, {});
    EXPECT_THAT(flag.errors, IsEmpty()) << setting.name();
    EXPECT_TRUE(HasOnly(flag.config, setting)) << setting.name();
    const CommandLine variable = Parse({}, {{setting.variable(), value}});
    EXPECT_THAT(variable.errors, IsEmpty()) << setting.name();
    EXPECT_TRUE(HasOnly(variable.config, setting)) << setting.name();
  }
}

TEST(EverySettingTest, ShowsInHelpWithItsDefault) {
  const std::string help = Parse({"--help"}, {}).print.value_or("");
  for (const Setting& setting : AllSettings()) {
    EXPECT_THAT(help, HasSubstr(absl::StrCat("--", setting.flag())));
    EXPECT_THAT(help, HasSubstr(setting.help()));
  }
}

TEST(EverySettingTest, NumberOutOfRangeIsRejectedByName) {
  for (const Setting& setting : AllSettings()) {
    if (setting.range_text().empty() || !setting.options().range().has_max()) continue;
    const double above = setting.options().range().max() + 1;
    const CommandLine line =
        Parse({absl::StrCat("--", setting.flag(), "=", static_cast<uint64_t>(above))}, {});
    EXPECT_THAT(
        ReadSettings(line, 4).mistakes,
        testing::Contains(AllOf(testing::StartsWith(absl::StrCat(setting.name(), ": expected ")),
                                HasSubstr(" (command line)"))));
  }
}

TEST(SettingTest, RangeNamesTheTypesLargestNumberAndAnExtraZero) {
  EXPECT_EQ(Setting(v1::ServerConfig::kMemoryLimitBytesFieldNumber).range_text(),
            "67108864 to 18446744073709551615");
  EXPECT_EQ(Setting(v1::ServerConfig::kWatchdogSecondsFieldNumber).range_text(),
            "0, or 1 to 86400");
  EXPECT_EQ(Setting(v1::ServerConfig::kMaxHeldBytesFieldNumber).range_text(),
            "max-request-bytes to 1099511627776");
}

TEST(SettingTest, HelpEndsWithTheDefault) {
  EXPECT_THAT(Setting(v1::ServerConfig::kMaxCallsFieldNumber).help(),
              testing::EndsWith(" (default 128)"));
  EXPECT_THAT(Setting(v1::ServerConfig::kReflectionFieldNumber).help(),
              testing::EndsWith(" (default on)"));
  EXPECT_THAT(Setting(v1::ServerConfig::kWorkersFieldNumber).help(),
              HasSubstr(" (default: one for each core"));
  EXPECT_THAT(Setting(v1::ServerConfig::kTlsKeyFileFieldNumber).help(), Not(HasSubstr("default")));
}

}  // namespace
}  // namespace duet::server::config

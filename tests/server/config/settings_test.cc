// docs/settings.md lists every setting. With DUET_WRITE_DOCUMENTS set, a test here writes it.
#include "server/config/settings.h"

#include <gmock/gmock.h>
#include <google/protobuf/text_format.h>
#include <google/protobuf/util/message_differencer.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "model/base/file.h"
#include "server/config/container_limits.h"
#include "server/config/load_config.h"
#include "tests/support/matchers.h"

namespace duet::server::config {
namespace {

constexpr auto kInvalidArgument = absl::StatusCode::kInvalidArgument;
constexpr std::uint64_t kMebibyte = std::uint64_t{1} << 20;

// Fills in the defaults of `given`. Fails with every mistake.
absl::StatusOr<v1::ServerConfig> ResolveSettings(const v1::ServerConfig& given, int cores,
                                                 const SettingSources& sources = {},
                                                 std::uint64_t memory_bytes = kUnlimitedMemory) {
  CommandLine line;
  line.config = given;
  line.sources = sources;
  return ResolveSettings(line, cores, memory_bytes);
}

v1::ServerConfig Given(const std::string& text) {
  v1::ServerConfig config;
  EXPECT_TRUE(google::protobuf::TextFormat::ParseFromString(text, &config)) << text;
  return config;
}

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

template <typename Number>
std::string RangeText(const v1::SettingRange& range) {
  const Number max =
      range.has_max() ? static_cast<Number>(range.max()) : std::numeric_limits<Number>::max();
  const std::string min =
      range.min_text().empty() ? absl::StrCat(static_cast<Number>(range.min())) : range.min_text();
  return absl::StrCat(range.or_zero() ? "0, or " : "", min, " to ", max);
}

// Such as "1 to 100000", with the numbers of the field's type. Empty if any value is valid.
std::string RangeText(const Setting& setting) {
  if (!setting.options().has_range()) return "";
  switch (setting.field().cpp_type()) {
    case Setting::Field::CPPTYPE_UINT32:
      return RangeText<uint32_t>(setting.options().range());
    case Setting::Field::CPPTYPE_UINT64:
      return RangeText<uint64_t>(setting.options().range());
    default:
      return RangeText<double>(setting.options().range());
  }
}

TEST(EverySettingTest, HasHelpAUnitAndANumberARange) {
  std::set<std::string> flags;
  for (const Setting& setting : AllSettings()) {
    EXPECT_FALSE(setting.options().help().empty()) << setting.name();
    EXPECT_FALSE(absl::EndsWith(setting.options().help(), ".")) << setting.name();
    const auto type = setting.field().cpp_type();
    EXPECT_EQ(!setting.unit().empty(), type != Setting::Field::CPPTYPE_BOOL) << setting.name();
    const bool is_number = type == Setting::Field::CPPTYPE_UINT32 ||
                           type == Setting::Field::CPPTYPE_UINT64 ||
                           type == Setting::Field::CPPTYPE_DOUBLE;
    EXPECT_EQ(!RangeText(setting).empty(), is_number) << setting.name();
    EXPECT_TRUE(flags.insert(setting.flag()).second) << setting.name();
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
    if (RangeText(setting).empty() || !setting.options().range().has_max()) continue;
    const double above = setting.options().range().max() + 1;
    const CommandLine line =
        Parse({absl::StrCat("--", setting.flag(), "=", static_cast<uint64_t>(above))}, {});
    EXPECT_THAT(ReadSettings(line, 4).mistakes,
                Contains(AllOf(StartsWith(absl::StrCat(setting.name(), ": expected ")),
                               HasSubstr(" (command line)"))));
  }
}

TEST(SettingTest, RangeNamesTheTypesLargestNumberAndAnExtraZero) {
  EXPECT_EQ(RangeText(Setting(v1::ServerConfig::kMemoryLimitBytesFieldNumber)),
            "67108864 to 18446744073709551615");
  EXPECT_EQ(RangeText(Setting(v1::ServerConfig::kWatchdogSecondsFieldNumber)), "0, or 1 to 86400");
  EXPECT_EQ(RangeText(Setting(v1::ServerConfig::kMaxHeldBytesFieldNumber)),
            "max-request-bytes to 1099511627776");
}

TEST(SettingTest, HelpEndsWithTheDefault) {
  EXPECT_THAT(Setting(v1::ServerConfig::kMaxCallsFieldNumber).help(), EndsWith(" (default 128)"));
  EXPECT_THAT(Setting(v1::ServerConfig::kReflectionFieldNumber).help(), EndsWith(" (default on)"));
  EXPECT_THAT(Setting(v1::ServerConfig::kWorkersFieldNumber).help(),
              HasSubstr(" (default: one for each core"));
  EXPECT_THAT(Setting(v1::ServerConfig::kTlsKeyFileFieldNumber).help(), Not(HasSubstr("default")));
}

constexpr char kIntroduction[] = R"(# Settings of duet-server

This page is generated from the options of [server_config.proto](../proto/duet/v1/server_config.proto), which
also has the details of each setting. To write it again:
`DUET_WRITE_DOCUMENTS=1 ctest --preset release -R '^server_config_test$'`.

Every setting is a flag, an environment variable (`DUET_SERVER_` and the flag's name, such as
`DUET_SERVER_MAX_CALLS` for `--max-calls`) and a field of the configuration file (`max_calls`). Flags override
variables, variables override the file. `duet-server --print-config` prints every value and its source.

| flag | value | default | range | what |
|---|---|---|---|---|
)";

std::string Cell(const std::string& text) {
  return absl::StrReplaceAll(text, {{"|", "\\|"}, {"<", "&lt;"}, {"*", "\\*"}});
}

std::string Document() {
  std::string text = kIntroduction;
  for (const Setting& setting : AllSettings()) {
    const bool is_value = !setting.options().default_value().empty();
    const std::string quote = is_value ? "`" : "";
    absl::StrAppend(&text, "| `--", setting.flag(), "` | ", Cell(setting.unit()), " | ", quote,
                    is_value ? setting.default_text() : Cell(setting.default_text()), quote, " | ",
                    RangeText(setting), " | ", Cell(setting.options().help()), " |\n");
  }
  return text;
}

TEST(SettingsDocumentTest, AgreesWithTheSchema) {
  const char* const source = std::getenv("DUET_SOURCE_DIR");
  ASSERT_NE(source, nullptr) << "set by ctest";
  const std::filesystem::path path = std::filesystem::path(source) / "docs" / "settings.md";
  if (std::getenv("DUET_WRITE_DOCUMENTS") != nullptr) std::ofstream(path) << Document();
  const absl::StatusOr<std::string> written =
      base::ReadFile(path, std::size_t{1} << 20, "a document");
  ASSERT_THAT(written, IsOk());
  EXPECT_EQ(*written, Document()) << "see the top of docs/settings.md";
}

TEST(SettingsTest, DefaultsServeTheEmbeddedCheckpointOnTheWellKnownPorts) {
  const absl::StatusOr<v1::ServerConfig> settings = ResolveSettings(v1::ServerConfig(), 4);
  ASSERT_THAT(settings, IsOk());
  EXPECT_EQ(settings->listen(), "0.0.0.0:50051");
  EXPECT_EQ(settings->metrics_listen(), "0.0.0.0:9464");
  EXPECT_TRUE(settings->model_repository().empty());
  EXPECT_EQ(settings->admin_listen(), "off");
  EXPECT_EQ(settings->workers(), 4);
}

TEST(SettingsTest, ValidValuesStayAsGiven) {
  const v1::ServerConfig given = Given(
      R"(listen: "[::1]:1" metrics_listen: "off" model_repository: "/models" default_model: "sbu"
         version_labels { model: "sbu" label: "stable" version: 3 }
         tls_certificate_file: "/c" tls_key_file: "/k" tls_client_ca_file: "/a" access_file: "/l"
         log_level: LOG_LEVEL_ERROR reflection: false precision: PRECISION_F32
         workers: 2 max_calls: 5 max_batch_delay_seconds: 0.25
         max_request_bytes: 4096 max_transport_bytes: 10000 clean_up: CLEAN_UP_POLICY_OFF)");
  const absl::StatusOr<v1::ServerConfig> settings = ResolveSettings(given, 4);
  ASSERT_THAT(settings, IsOk());
  google::protobuf::util::MessageDifferencer differencer;
  differencer.set_scope(google::protobuf::util::MessageDifferencer::PARTIAL);
  EXPECT_TRUE(differencer.Compare(given, *settings)) << settings->DebugString();
}

TEST(SettingsTest, AddressesGetTheirNormalForm) {
  const auto settings = ResolveSettings(Given("listen: ':7' metrics_listen: ''"), 4);
  ASSERT_THAT(settings, IsOk());
  EXPECT_EQ(settings->listen(), "0.0.0.0:7");
  EXPECT_EQ(settings->metrics_listen(), "off");
}

TEST(SettingsTest, EveryCoreHasAWorkerByDefault) {
  EXPECT_EQ(ResolveSettings(v1::ServerConfig(), 7)->workers(), 7);
  EXPECT_EQ(ResolveSettings(Given("workers: 2"), 7)->workers(), 2);
}

TEST(SettingsTest, MistakesNameTheFieldWhatIsExpectedAndWhatWasGiven) {
  const std::pair<const char*, const char*> cases[] = {
      {"listen: '50051'", "listen: expected host:port"},
      {"metrics_listen: 'a:b'", "metrics_listen: expected host:port"},
      {"admin_listen: 'b'", "admin_listen: expected host:port"},
      {"workers: 0", "workers: expected 1 to 1024, got 0"},
      {"workers: 129", "workers: expected 1 to 32 on 4 cores, got 129"},
      {"precision: 9",
       "precision: expected PRECISION_AUTO, PRECISION_F32 or PRECISION_INT16, got 9"},
      {"watchdog_seconds: 0.5", "watchdog_seconds: expected 0, or 1 to 86400, got 0.5"},
      {"max_request_bytes: 4294967296",
       "max_request_bytes: expected 1024 to 536870912, got 4294967296"},
      {"max_transport_bytes: 67108863",
       "max_transport_bytes: expected 67108864 to 1099511627776, got 67108863"},
      {"memory_limit_bytes: 1000",
       "memory_limit_bytes: expected 67108864 to 18446744073709551615, got 1000"},
      {"grace_seconds: nan", "grace_seconds: expected 0 to 3600, got nan"},
      {"tls_certificate_file: '/c'",
       "tls_key_file: expected a file beside tls_certificate_file, got none"},
      {"tls_key_file: '/k'", "tls_certificate_file: expected a file beside tls_key_file, got none"},
      {"tls_client_ca_file: '/a'", "tls_client_ca_file: expected tls_certificate_file"},
      {"version_labels {}", "version_labels[0]: expected a model, a label"},
      {"client_key: 'X-Client'", "client_key: expected lower-case letters"},
      {"client_key: 'x:client'", "client_key: expected lower-case letters"},
      {"client_key: 'client-bin'", "client_key: expected lower-case letters"}};
  for (const auto& [text, mistake] : cases) {
    EXPECT_THAT(ResolveSettings(Given(text), 4), StatusIs(kInvalidArgument, HasSubstr(mistake)));
  }
  EXPECT_THAT(ResolveSettings(Given("client_key: 'x-client_1.a' workers: 32"), 4), IsOk());
}

TEST(SettingsTest, ReportsEveryMistakeWithItsSource) {
  EXPECT_THAT(ResolveSettings(Given("listen: 'nowhere' max_calls: 0 drain_seconds: -1"), 4,
                              {{"max_calls", "file a:1:2"}}),
              StatusIs(kInvalidArgument,
                       AllOf(HasSubstr("listen: "),
                             HasSubstr("\nmax_calls: expected 1 to 100000, got 0 (file a:1:2)\n"),
                             HasSubstr("\ndrain_seconds: expected 0 to 3600, got -1"))));
}

TEST(SettingsTest, RejectsListenersOnTheSamePort) {
  for (const char* good : {"listen: ':1' metrics_listen: ':2' admin_listen: ':3'",
                           "listen: ':0' metrics_listen: ':0' admin_listen: ':0'",
                           "listen: '127.0.0.1:1' metrics_listen: '127.0.0.2:1' "
                           "admin_listen: '[::1]:1'",
                           "listen: ':1' metrics_listen: 'off'",
                           "listen: 'localhost:1' metrics_listen: '127.0.0.2:1'"}) {
    EXPECT_THAT(ResolveSettings(Given(good), 4), IsOk()) << good;
  }
  for (const char* bad :
       {"listen: ':1' metrics_listen: ':1'", "listen: ':1' metrics_listen: '127.0.0.1:1'",
        "listen: '127.0.0.1:1' metrics_listen: ':1'",
        "listen: '[::]:1' metrics_listen: '10.0.0.1:1'",
        "listen: 'localhost:1' metrics_listen: '127.0.0.1:1'",
        "listen: '[::1]:1' metrics_listen: 'localhost:1'",
        "listen: '0.0.0.0:9464'"}) {  // the default of the other
    EXPECT_THAT(ResolveSettings(Given(bad), 4),
                StatusIs(kInvalidArgument,
                         AllOf(HasSubstr("metrics_listen: expected another port than listen, got "),
                               HasSubstr("; listen is "))))
        << bad;
  }
  EXPECT_THAT(
      ResolveSettings(Given("listen: ':7' metrics_listen: ':7' admin_listen: ':7'"), 4,
                      {{"admin_listen", "command line"}}),
      StatusIs(kInvalidArgument,
               AllOf(HasSubstr("metrics_listen: expected another port than listen"),
                     HasSubstr("\nadmin_listen: expected another port than listen, got 0.0.0.0:7 "
                               "(command line); listen is 0.0.0.0:7; port 0 is any free one, "
                               "\"off\" none"),
                     HasSubstr("\nadmin_listen: expected another port than metrics_listen"))));
}

v1::ServerConfig Planned(std::uint64_t mebibytes, const std::string& given = "", int cores = 2) {
  const auto settings = ResolveSettings(Given(given), cores, {}, mebibytes * kMebibyte);
  EXPECT_THAT(settings, IsOk());
  return settings.ok() ? *settings : v1::ServerConfig();
}

std::vector<std::string> WarningsOf(const v1::ServerConfig& settings, std::uint64_t mebibytes) {
  return MemoryWarnings(settings, mebibytes * kMebibyte);
}

TEST(MemoryPlanTest, DefaultsFitSmallContainersAndGrowWithThem) {
  for (const int cores : {1, 2, 4}) {
    v1::ServerConfig before = Planned(64, "", cores);
    for (std::uint64_t memory = 160; memory < 5000; memory += memory < 500 ? 8 : 100) {
      const v1::ServerConfig now = Planned(memory, "", cores);
      EXPECT_LE(NeedOf(now).total(), memory * kMebibyte) << memory << " MiB, " << cores;
      EXPECT_THAT(WarningsOf(now, memory), IsEmpty()) << memory;
      EXPECT_GE(now.max_calls(), before.max_calls()) << memory;
      EXPECT_GE(now.max_request_bytes(), before.max_request_bytes()) << memory;
      EXPECT_GE(NeedOf(now).total(), NeedOf(before).total()) << memory;
      before = now;
    }
  }
}

TEST(MemoryPlanTest, LimitsDependOnTheMemory) {
  const v1::ServerConfig ample = Planned(2048);
  EXPECT_EQ(ample.max_calls(), 128);
  EXPECT_EQ(ample.max_request_bytes(), 32 * kMebibyte);
  EXPECT_EQ(ample.max_transport_bytes(), 512 * kMebibyte);
  EXPECT_EQ(ample.max_held_bytes(), 512 * kMebibyte);
  EXPECT_EQ(ample.max_slow_requests(), 8);
  const v1::ServerConfig little = Planned(400);
  EXPECT_EQ(little.max_calls(), 128) << "held bytes shrink before calls and requests";
  EXPECT_EQ(little.max_request_bytes(), 32 * kMebibyte);
  EXPECT_EQ(little.max_transport_bytes(), 96 * kMebibyte);
  EXPECT_EQ(little.max_slow_requests(), 1);
  EXPECT_LT(little.max_held_bytes(), 128 * kMebibyte);
  EXPECT_GE(little.max_held_bytes(), 52000000u) << "two leaders of ten minutes at 240 Hz";
  const v1::ServerConfig too_little = Planned(64);
  EXPECT_EQ(too_little.max_calls(), 4);
  EXPECT_EQ(too_little.max_request_bytes(), kMebibyte);
  EXPECT_EQ(too_little.max_transport_bytes(), 3 * kMebibyte);
  EXPECT_EQ(too_little.max_held_bytes(), kMebibyte);
  EXPECT_THAT(WarningsOf(too_little, 64),
              ElementsAre(AllOf(HasSubstr("the limit is 67 MB"), HasSubstr("max_calls = 4"))));
}

TEST(MemoryPlanTest, ExplicitSettingsAreKeptAndOthersShrink) {
  const std::string held = absl::StrCat("max_held_bytes: ", 300 * kMebibyte);
  EXPECT_EQ(Planned(800, held).max_held_bytes(), 300 * kMebibyte);
  EXPECT_THAT(WarningsOf(Planned(800, held), 800), IsEmpty());
  const v1::ServerConfig all =
      Planned(400, held + " max_calls: 7 max_request_bytes: 5242880 max_transport_bytes: 11534336");
  EXPECT_EQ(all.max_calls(), 7);
  EXPECT_EQ(all.max_request_bytes(), 5 * kMebibyte);
  EXPECT_EQ(all.max_transport_bytes(), 11 * kMebibyte);
  EXPECT_EQ(all.max_held_bytes(), 300 * kMebibyte);
}

TEST(MemoryPlanTest, WarnsAboutExplicitSettingsThatDoNotFit) {
  EXPECT_THAT(
      WarningsOf(Planned(400, "max_held_bytes: 536870912 max_transport_bytes: 536870912"), 400),
      ElementsAre(AllOf(HasSubstr("the limit is 419 MB"), HasSubstr("536 MB for max_held_bytes"),
                        HasSubstr("536 MB for max_transport_bytes"))));
  EXPECT_THAT(
      WarningsOf(Planned(400, absl::StrCat("memory_limit_bytes: ", 4000 * kMebibyte)), 400),
      ElementsAre(AllOf(HasSubstr("got 4194304000"), HasSubstr("expected at most 419430400")),
                  HasSubstr("the limit is 419 MB")));
}

}  // namespace
}  // namespace duet::server::config

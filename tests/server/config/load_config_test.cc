#include "server/config/load_config.h"

#include <gmock/gmock.h>
#include <google/protobuf/text_format.h>
#include <google/protobuf/util/message_differencer.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <tuple>
#include <vector>

#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "model/messages/message_text.h"
#include "server/config/settings.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::server::config {
namespace {

using test::TemporaryFolder;
using test::WriteTestFile;

constexpr auto kInvalidArgument = absl::StatusCode::kInvalidArgument;

v1::ServerConfig Given(const std::string& text) {
  v1::ServerConfig config;
  EXPECT_TRUE(google::protobuf::TextFormat::ParseFromString(text, &config)) << text;
  return config;
}

absl::StatusOr<CommandLine> Parse(std::vector<std::string> arguments,
                                  const Environment& environment = {}) {
  std::vector<const char*> argv = {"duet-server"};
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  CommandLine line = ParseCommandLine(static_cast<int>(argv.size()), argv.data(), environment);
  if (line.errors.empty()) return line;
  return absl::InvalidArgumentError(absl::StrJoin(line.errors, "\n"));
}

absl::Status Read(const std::filesystem::path& path) {
  v1::ServerConfig config;
  messages::FieldPlaces places;
  return ReadConfigFile(path, &config, &places);
}

TEST(ReadConfigFileTest, ReadsTextFormatWithCommentsAndJson) {
  TemporaryFolder folder;
  WriteTestFile(folder / "a.textproto",
                "# two replicas\nlisten: \":7\" max_calls: 3 drain_seconds: 1.5");
  WriteTestFile(folder / "a.json", R"({"listen": ":7", "maxCalls": 3, "drain_seconds": 1.5})");
  for (const char* name : {"a.textproto", "a.json"}) {
    v1::ServerConfig config;
    messages::FieldPlaces places;
    ASSERT_THAT(ReadConfigFile(folder / name, &config, &places), IsOk());
    EXPECT_EQ(config.listen(), ":7");
    EXPECT_EQ(config.max_calls(), 3u);
    EXPECT_EQ(config.drain_seconds(), 1.5);
  }
}

TEST(ReadConfigFileTest, ErrorNamesTheFile) {
  TemporaryFolder folder;
  EXPECT_THAT(Read(folder / "absent.txtpb"),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr("absent.txtpb")));
  EXPECT_THAT(Read(folder.path()),
              StatusIs(kInvalidArgument,
                       HasSubstr(folder.path().string() + ": expected a file, got a folder")));
  WriteTestFile(folder / "bad.json", "{");
  EXPECT_THAT(Read(folder / "bad.json"), StatusIs(kInvalidArgument, HasSubstr("bad.json")));
}

TEST(ReadConfigFileTest, ReportsEveryMistakeWithItsPlace) {
  TemporaryFolder folder;
  WriteTestFile(folder / "bad.txtpb", "max_call: 7\nworkers: -2");
  const std::string start = "--config: " + (folder / "bad.txtpb").string();
  EXPECT_THAT(
      Read(folder / "bad.txtpb"),
      StatusIs(kInvalidArgument, AllOf(StartsWith(start + ": line 1:9: "), HasSubstr("max_call"),
                                       HasSubstr("\n" + start + ": line 2:10: "))));
}

TEST(ParseCommandLineTest, ReadsFlagsOfEveryKind) {
  const absl::StatusOr<CommandLine> line =
      Parse(absl::StrSplit("--listen a:1 --no-reflection --workers 2 --max-request-bytes 6000 "
                           "--drain-seconds 0.5 --precision f32 --clean-up off --models free "
                           "--version-label sbu:stable=3 --version-label sbu:canary=4",
                           ' '));
  ASSERT_THAT(line, IsOk());
  const v1::ServerConfig expected = Given(
      R"(listen: "a:1" reflection: false workers: 2 max_request_bytes: 6000 drain_seconds: 0.5
         precision: PRECISION_F32 clean_up: CLEAN_UP_POLICY_OFF models: SERVED_MODELS_FREE
         version_labels { model: "sbu" label: "stable" version: 3 }
         version_labels { model: "sbu" label: "canary" version: 4 })");
  EXPECT_TRUE(google::protobuf::util::MessageDifferencer::Equals(line->config, expected))
      << line->config.DebugString();
}

TEST(ParseCommandLineTest, ErrorNamesTheFlagOrVariable) {
  using Arguments = std::vector<std::string>;
  const std::tuple<Arguments, Environment, std::string> cases[] = {
      {{"--max-cals", "4"}, {}, "--max-cals"},
      {{"serve"}, {}, "not expected: serve"},
      {{"--listen"}, {}, "--listen"},
      {{"--workers", "-2"}, {}, "--workers: expected a whole number of 0 or more, got \"-2\""},
      {{"--workers", "1", "--workers", "2"}, {}, "--workers"},
      {{"--clean-up", "maybe"}, {}, "--clean-up: expected auto, on or off, got \"maybe\""},
      {{"--reflection=tr"}, {}, "--reflection: expected true or false, got \"tr\""},
      {{},
       {{"DUET_SERVER_REFLECTION", "99999999999999999999"}},
       "DUET_SERVER_REFLECTION: expected true or false, got \"99999999999999999999\""},
      {{}, {{"DUET_SERVER_MAX_CALL", "1"}}, "DUET_SERVER_MAX_CALL: sets nothing"},
      {{}, {{"DUET_SERVER_CHECK_CONFIG", "true"}}, "sets nothing"},
  };
  for (const auto& [arguments, environment, mistake] : cases) {
    EXPECT_THAT(Parse(arguments, environment), StatusIs(kInvalidArgument, HasSubstr(mistake)));
  }
  for (const char* label : {"stable", "sbu:stable", "sbu:stable=", "sbu:stable=x", "sbu=3"}) {
    EXPECT_THAT(Parse({"--version-label", label}),
                StatusIs(kInvalidArgument, HasSubstr("model:label=version")))
        << label;
  }
}

TEST(ParseCommandLineTest, PrintsTheVersion) {
  const absl::StatusOr<CommandLine> line = Parse({"--version"});
  ASSERT_THAT(line, IsOk());
  EXPECT_THAT(line->print.value_or(""), ContainsRegex("^duet-server [0-9]+\\.[0-9]+\\.[0-9]+\n$"));
}

TEST(ParseCommandLineTest, AcceptsAnEmptyValue) {
  const absl::StatusOr<CommandLine> line = Parse({"--metrics-listen", "", "--workers", "2"});
  ASSERT_THAT(line, IsOk());
  EXPECT_TRUE(line->config.has_metrics_listen());
  EXPECT_EQ(line->config.metrics_listen(), "");
  EXPECT_EQ(line->config.workers(), 2u);
}

TEST(ParseCommandLineTest, ReportsEveryWrongValueAndKeepsTheOthers) {
  const std::vector<const char*> argv = {
      "duet-server", "--workers",  "two",   "--max-calls=x",   "--grace-seconds",
      "soon",        "--clean-up", "maybe", "--no-reflection", "--drain-seconds",
      "-2"};
  const CommandLine line =
      ParseCommandLine(static_cast<int>(argv.size()), argv.data(),
                       {{"DUET_SERVER_WORKERS", "1.5"}, {"DUET_SERVER_PRECISION", "f64"}});
  EXPECT_THAT(line.errors, UnorderedElementsAre(
                               "--workers: expected a whole number of 0 or more, got \"two\"",
                               "--max-calls: expected a whole number of 0 or more, got \"x\"",
                               "--grace-seconds: expected a number, got \"soon\"",
                               "--clean-up: expected auto, on or off, got \"maybe\"",
                               "DUET_SERVER_PRECISION: expected auto, f32 or int16, got \"f64\"",
                               "DUET_SERVER_WORKERS: expected a whole number of 0 or more, got "
                               "\"1.5\""));
  EXPECT_EQ(line.config.drain_seconds(), -2);
  EXPECT_FALSE(line.config.reflection());
  EXPECT_THAT(ReadSettings(line, 4).mistakes,
              Contains("drain_seconds: expected 0 to 3600, got -2 (command line)"));
}

TEST(EnvironmentTest, HasTheServersVariablesWithoutThoseOfKubernetes) {
  const char* variables[] = {"DUET_SERVER=lab:1",
                             "DUET_SERVER_MAX_CALLS=4",
                             "PATH=/bin",
                             "DUET_SERVER_LISTEN=a=b",
                             "DUET_SERVER_EMPTY=",
                             "DUET_SERVER_SERVICE_HOST=10.0.0.1",
                             "DUET_SERVER_SERVICE_PORT_GRPC=50051",
                             "DUET_SERVER_PORT=tcp://10.0.0.1:50051",
                             "DUET_SERVER_PORT_50051_TCP_ADDR=10.0.0.1",
                             nullptr};
  EXPECT_THAT(ReadEnvironment(variables),
              ElementsAre(Pair("DUET_SERVER_EMPTY", ""), Pair("DUET_SERVER_LISTEN", "a=b"),
                          Pair("DUET_SERVER_MAX_CALLS", "4")));
}

TEST(ParseCommandLineTest, HelpNamesBothFormsOfASwitch) {
  const std::array<const char*, 2> argv = {"duet-server", "--help"};
  const CommandLine line = ParseCommandLine(2, argv.data(), {});
  EXPECT_THAT(*line.print, HasSubstr("  --reflection,--no-reflection\n"));
}

TEST(ParseCommandLineTest, FlagsOverrideVariablesAndVariablesOverrideTheFile) {
  TemporaryFolder folder;
  WriteTestFile(folder / "server.txtpb",
                "listen: \"file:1\" max_calls: 9\nmax_queued_windows: 3\n"
                "version_labels { model: \"a\" label: \"b\" version: 1 }");
  const std::string file = (folder / "server.txtpb").string();
  const absl::StatusOr<CommandLine> line =
      Parse({"--listen", "flag:2"}, {{"DUET_SERVER_CONFIG", file},
                                     {"DUET_SERVER_LISTEN", "variable:3"},
                                     {"DUET_SERVER_MAX_CALLS", "4"},
                                     {"DUET_SERVER_METRICS_LISTEN", ""},
                                     {"DUET_SERVER_REFLECTION", "false"},
                                     {"DUET_SERVER_VERSION_LABEL", "a:c=2 a:d=3"}});
  ASSERT_THAT(line, IsOk());
  EXPECT_EQ(line->config.listen(), "flag:2");
  EXPECT_EQ(line->config.max_calls(), 4u);
  EXPECT_EQ(line->config.max_queued_windows(), 3u);
  EXPECT_TRUE(line->config.has_metrics_listen());
  EXPECT_FALSE(line->config.reflection());
  ASSERT_EQ(line->config.version_labels_size(), 3);
  EXPECT_THAT(
      line->sources,
      UnorderedElementsAre(Pair("listen", "command line"),
                           Pair("max_calls", "environment DUET_SERVER_MAX_CALLS"),
                           Pair("max_queued_windows", "file " + file + ":2:1"),
                           Pair("metrics_listen", "environment DUET_SERVER_METRICS_LISTEN"),
                           Pair("reflection", "environment DUET_SERVER_REFLECTION"),
                           Pair("version_labels[0]", "file " + file + ":3:1"),
                           Pair("version_labels[1]", "environment DUET_SERVER_VERSION_LABEL"),
                           Pair("version_labels[2]", "environment DUET_SERVER_VERSION_LABEL")));
}

TEST(ParseCommandLineTest, SwitchesSelectTheTask) {
  EXPECT_EQ(Parse({})->task, Task::kServe);
  EXPECT_EQ(Parse({"--check-config"})->task, Task::kCheckConfig);
  EXPECT_EQ(Parse({"--print-config"})->task, Task::kPrintConfig);
  EXPECT_EQ(Parse({"--check-health"})->task, Task::kCheckHealth);
}

TEST(ResolveSettingsTest, ReportsTheMistakesOfEverySourceWithTheSource) {
  TemporaryFolder folder;
  WriteTestFile(folder / "a.txtpb", "prot: 1\n  max_calls: 0");
  const std::string file = (folder / "a.txtpb").string();
  const std::vector<const char*> argv = {"duet-server", "--config", file.c_str(), "--workers", "0"};
  const CommandLine line =
      ParseCommandLine(static_cast<int>(argv.size()), argv.data(),
                       {{"DUET_SERVER_GRACE_SECONDS", "-1"}, {"DUET_SERVER_DRAIN_SECONDS", "x"}});
  const absl::StatusOr<v1::ServerConfig> options = ResolveSettings(line, 4);
  EXPECT_THAT(
      options,
      StatusIs(kInvalidArgument,
               AllOf(HasSubstr("DUET_SERVER_DRAIN_SECONDS: "), HasSubstr("a.txtpb: line 1:5: "),
                     HasSubstr("prot"),
                     HasSubstr("\nmax_calls: expected 1 to 100000, got 0 (file " + file + ":2:3)"),
                     HasSubstr("\nworkers: expected 1 to 1024, got 0 (command line)"),
                     HasSubstr("\ngrace_seconds: expected 0 to 3600, got -1 (environment "
                               "DUET_SERVER_GRACE_SECONDS)"))));
}

TEST(PrintConfigTest, PrintsEveryValueWithItsSource) {
  v1::ServerConfig config;
  config.set_max_calls(64);
  for (const int version : {3, 4}) {
    v1::VersionLabel& label = *config.add_version_labels();
    label.set_model("sbu");
    label.set_label("v");
    label.set_version(static_cast<uint32_t>(version));
  }
  const v1::ServerConfig settings = ReadSettings(config, 2).values;
  const std::string text =
      PrintConfig(settings, {{"max_calls", "file a:3:1"}, {"version_labels[1]", "command line"}});
  EXPECT_THAT(text, AllOf(HasSubstr("\nmax_calls: 64  # file a:3:1\n"),
                          HasSubstr("\nworkers: 2  # default\n"),
                          HasSubstr("\nversion_labels { model: \"sbu\" label: \"v\" version: 4 }"
                                    "  # command line\n"),
                          HasSubstr("\n# tls_key_file is not set\n")));
  // It is a configuration file with the same settings.
  const v1::ServerConfig again = Given(text);
  EXPECT_TRUE(
      google::protobuf::util::MessageDifferencer::Equals(ReadSettings(again, 7).values, settings));
}

}  // namespace
}  // namespace duet::server::config

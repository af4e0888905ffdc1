#include "server/config/load_config.h"

#include <gmock/gmock.h>
#include <google/protobuf/util/message_differencer.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "server/config/settings.h"
#include "tests/server/support/settings.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace duet::server::config {
namespace {

using test::ParseConfigText;

using test::TemporaryFolder;
using test::WriteTestFile;

constexpr auto kInvalidArgument = absl::StatusCode::kInvalidArgument;

absl::StatusOr<CommandLine> Parse(std::vector<std::string> arguments,
                                  const Environment& environment = {}) {
  std::vector<const char*> argv = {"duet-server"};
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  CommandLine line = ParseCommandLine(static_cast<int>(argv.size()), argv.data(), environment);
  if (line.errors.empty()) return line;
  return absl::InvalidArgumentError(absl::StrJoin(line.errors, "\n"));
}

TEST(ParseConfigTextTest, ReadsTextFormatWithComments) {
  const absl::StatusOr<v1::ServerConfig> config = ParseConfigText(
      "# two replicas\nlisten: \":7\"\nversion_labels { model: \"a\" label: \"b\" version: 3 }\n",
      /*json=*/false);
  ASSERT_THAT(config, IsOk());
  EXPECT_EQ(config->listen(), ":7");
  EXPECT_EQ(config->version_labels(0).version(), 3u);
}

TEST(ParseConfigTextTest, ReadsJson) {
  const absl::StatusOr<v1::ServerConfig> config =
      ParseConfigText(R"({"listen": ":7", "maxCalls": 3, "drain_seconds": 1.5})", /*json=*/true);
  ASSERT_THAT(config, IsOk());
  EXPECT_EQ(config->listen(), ":7");
  EXPECT_EQ(config->max_calls(), 3u);
  EXPECT_EQ(config->drain_seconds(), 1.5);
}

absl::Status Read(const std::filesystem::path& path) {
  v1::ServerConfig config;
  messages::FieldPlaces places;
  return ReadConfigFile(path, &config, &places);
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

TEST(ParseConfigTextTest, RejectsASettingThatIsGone) {
  EXPECT_THAT(ParseConfigText("otlp_endpoint: \"collector\"", /*json=*/false),
              StatusIs(kInvalidArgument, HasSubstr("otlp_endpoint")));
}

TEST(ReadConfigFileTest, ReportsEveryMistakeWithItsPlace) {
  TemporaryFolder folder;
  WriteTestFile(folder / "bad.json", "{\"workers\": -2,\n  \"max_call\": 7, \"maxCalls\": 9}");
  const std::string start = "--config: " + (folder / "bad.json").string();
  EXPECT_THAT(
      Read(folder / "bad.json"),
      StatusIs(kInvalidArgument, AllOf(StartsWith(start + ": line 1:2: (workers)"),
                                       HasSubstr("\n" + start +
                                                 ": line 2:3: there is no field \"max_call\"; "
                                                 "did you mean max_calls?"))));
}

TEST(ParseCommandLineTest, ReadsFlagsOfEveryKind) {
  const absl::StatusOr<CommandLine> line = Parse(absl::StrSplit(
      "--tls-certificate-file /c --tls-key-file /k --tls-client-ca-file /a --access-file /l "
      "--log-level warning --log-refusals-per-second 3 --listen a:1 --metrics-listen off "
      "--model-repository /models --default-model sbu "
      "--version-label sbu:stable=3 --version-label sbu:canary=4 --no-reflection --workers 2 "
      "--threads-per-worker 3 --max-calls 4 --max-queued-windows 5 --max-request-bytes 6000 "
      "--max-transport-bytes 20000 --memory-limit-bytes 400000000 --buffered-frames 7 "
      "--drain-seconds 8 --grace-seconds 9 "
      "--clean-up off --engine torch --precision f32 --max-batch-windows 10 "
      "--admin-listen b:2 --models free "
      "--max-batch-delay-seconds 0.5 --client-share 0.5 --client-key x-client "
      "--max-held-bytes 30000 --receive-timeout-seconds 11 --write-timeout-seconds 12 "
      "--max-call-seconds 13 --self-check-seconds 14 --watchdog-seconds 16 --max-slow-requests 15",
      ' '));
  ASSERT_THAT(line, IsOk());
  const absl::StatusOr<v1::ServerConfig> expected = ParseConfigText(
      R"(listen: "a:1" metrics_listen: "off" model_repository: "/models" default_model: "sbu"
         version_labels { model: "sbu" label: "stable" version: 3 }
         version_labels { model: "sbu" label: "canary" version: 4 }
         reflection: false workers: 2 threads_per_worker: 3 max_calls: 4 max_queued_windows: 5
         max_request_bytes: 6000 max_transport_bytes: 20000
         memory_limit_bytes: 400000000 buffered_frames: 7 drain_seconds: 8 grace_seconds: 9
         clean_up: CLEAN_UP_POLICY_OFF engine: ENGINE_TORCH precision: PRECISION_F32
         max_batch_windows: 10 max_batch_delay_seconds: 0.5
         admin_listen: "b:2" models: SERVED_MODELS_FREE
         tls_certificate_file: "/c" tls_key_file: "/k" tls_client_ca_file: "/a" access_file: "/l"
         log_level: LOG_LEVEL_WARNING log_refusals_per_second: 3
         client_share: 0.5 client_key: "x-client" max_held_bytes: 30000
         receive_timeout_seconds: 11 write_timeout_seconds: 12 max_call_seconds: 13
         self_check_seconds: 14 max_slow_requests: 15 watchdog_seconds: 16)",
      false);
  ASSERT_THAT(expected, IsOk());
  EXPECT_TRUE(google::protobuf::util::MessageDifferencer::Equals(line->config, *expected))
      << line->config.DebugString();
}

TEST(ParseCommandLineTest, AcceptsOnlyTheChoicesOfAnEnum) {
  EXPECT_EQ(Parse({"--clean-up", "auto"})->config.clean_up(), v1::CLEAN_UP_POLICY_AUTO);
  EXPECT_EQ(Parse({"--clean-up", "on"})->config.clean_up(), v1::CLEAN_UP_POLICY_ON);
  EXPECT_EQ(Parse({"--models", "all"})->config.models(), v1::SERVED_MODELS_ALL);
  EXPECT_THAT(
      Parse({"--clean-up", "maybe"}),
      StatusIs(kInvalidArgument, HasSubstr("--clean-up: expected auto, on or off, got \"maybe\"")));
}

TEST(ParseCommandLineTest, SuggestsAFlagForAMisspelledOne) {
  EXPECT_THAT(
      Parse({"--max-cals", "4"}),
      StatusIs(kInvalidArgument, "--max-cals: there is no such flag; did you mean --max-calls?"));
  EXPECT_THAT(Parse({"serve"}), StatusIs(kInvalidArgument, "expected flags only, got \"serve\""));
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

TEST(ParseCommandLineTest, ErrorNamesTheFlag) {
  EXPECT_THAT(Parse({"--prot", "7"}), StatusIs(kInvalidArgument, HasSubstr("--prot")));
  EXPECT_THAT(Parse({"--workers", "two"}), StatusIs(kInvalidArgument, HasSubstr("--workers")));
  EXPECT_THAT(Parse({"--workers", "-2"}), StatusIs(kInvalidArgument, HasSubstr("--workers")));
  EXPECT_THAT(Parse({"--listen"}), StatusIs(kInvalidArgument, HasSubstr("--listen")));
  EXPECT_THAT(Parse({"stray"}), StatusIs(kInvalidArgument, HasSubstr("stray")));
  for (const char* label : {"stable", "sbu:stable", "sbu:stable=", "sbu:stable=x", "sbu=3"}) {
    EXPECT_THAT(Parse({"--version-label", label}),
                StatusIs(kInvalidArgument, HasSubstr("model:label=version")))
        << label;
  }
}

TEST(ParseCommandLineTest, ReportsEveryWrongValueAndKeepsTheOthers) {
  const std::vector<const char*> argv = {
      "duet-server", "--workers",  "two",   "--max-calls=x",   "--grace-seconds",
      "soon",        "--clean-up", "maybe", "--no-reflection", "--drain-seconds",
      "-2"};
  const CommandLine line =
      ParseCommandLine(static_cast<int>(argv.size()), argv.data(),
                       {{"DUET_SERVER_WORKERS", "1.5"}, {"DUET_SERVER_ENGINE", "gpu"}});
  EXPECT_THAT(line.errors,
              UnorderedElementsAre("--workers: expected a whole number of 0 or more, got \"two\"",
                                   "--max-calls: expected a whole number of 0 or more, got \"x\"",
                                   "--grace-seconds: expected a number, got \"soon\"",
                                   "--clean-up: expected auto, on or off, got \"maybe\"",
                                   "DUET_SERVER_ENGINE: expected cpu or torch, got \"gpu\"",
                                   "DUET_SERVER_WORKERS: expected a whole number of 0 or more, got "
                                   "\"1.5\""));
  EXPECT_EQ(line.config.drain_seconds(), -2);
  EXPECT_FALSE(line.config.reflection());
  EXPECT_THAT(ReadSettings(line, 4).mistakes,
              testing::Contains("drain_seconds: expected 0 to 3600, got -2 (command line)"));
}

TEST(ParseCommandLineTest, RejectsARepeatedFlag) {
  EXPECT_THAT(Parse({"--workers", "1", "--workers", "2"}),
              StatusIs(kInvalidArgument, HasSubstr("--workers")));
}

TEST(ParseCommandLineTest, RejectsASwitchThatIsNeitherTrueNorFalse) {
  for (const std::string value : {"maybe", "99999999999999999999", "1x", "tr"}) {
    const std::string mistake = "expected true or false, got \"" + value + "\"";
    EXPECT_THAT(Parse({"--reflection=" + value}),
                StatusIs(kInvalidArgument, "--reflection: " + mistake));
    EXPECT_THAT(Parse({}, {{"DUET_SERVER_REFLECTION", value}}),
                StatusIs(kInvalidArgument, "DUET_SERVER_REFLECTION: " + mistake));
  }
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

TEST(ParseCommandLineTest, ErrorNamesTheVariable) {
  EXPECT_THAT(
      Parse({}, {{"DUET_SERVER_MAX_CALL", "1"}, {"DUET_SERVER_WORKERS", "two"}}),
      StatusIs(kInvalidArgument, AllOf(HasSubstr("DUET_SERVER_MAX_CALL: sets nothing; did you mean "
                                                 "DUET_SERVER_MAX_CALLS?"),
                                       HasSubstr("\nDUET_SERVER_WORKERS: "), HasSubstr("two"))));
  EXPECT_THAT(Parse({}, {{"DUET_SERVER_CHECK_CONFIG", "true"}}),
              StatusIs(kInvalidArgument, HasSubstr("sets nothing")));
}

TEST(ParseCommandLineTest, SwitchesSelectTheTask) {
  EXPECT_EQ(Parse({})->task, Task::kServe);
  EXPECT_EQ(Parse({"--check-config"})->task, Task::kCheckConfig);
  EXPECT_EQ(Parse({"--print-config"})->task, Task::kPrintConfig);
  EXPECT_EQ(Parse({"--check-health"})->task, Task::kCheckHealth);
}

TEST(ResolveSettingsTest, ReportsTheMistakesOfEverySourceWithTheSource) {
  TemporaryFolder folder;
  WriteTestFile(folder / "a.json", "{\n  \"prot\": 1,\n  \"maxCalls\": 0}");
  const std::string file = (folder / "a.json").string();
  const std::vector<const char*> argv = {"duet-server", "--config", file.c_str(), "--workers", "0"};
  const CommandLine line =
      ParseCommandLine(static_cast<int>(argv.size()), argv.data(),
                       {{"DUET_SERVER_GRACE_SECONDS", "-1"}, {"DUET_SERVER_DRAIN_SECONDS", "x"}});
  const absl::StatusOr<v1::ServerConfig> options = ResolveSettings(line, 4);
  EXPECT_THAT(
      options,
      StatusIs(kInvalidArgument,
               AllOf(HasSubstr("DUET_SERVER_DRAIN_SECONDS: "),
                     HasSubstr("a.json: line 2:3: there is no field \"prot\""),
                     HasSubstr("\nmax_calls: expected 1 to 100000, got 0 (file " + file + ":3:3)"),
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
  const absl::StatusOr<v1::ServerConfig> again = ParseConfigText(text, /*json=*/false);
  ASSERT_THAT(again, IsOk());
  EXPECT_TRUE(
      google::protobuf::util::MessageDifferencer::Equals(ReadSettings(*again, 7).values, settings));
}

}  // namespace
}  // namespace duet::server::config

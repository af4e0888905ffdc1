#include "server/config/settings.h"

#include <gmock/gmock.h>
#include <google/protobuf/util/message_differencer.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "server/config/load_config.h"
#include "tests/server/support/settings.h"
#include "tests/support/matchers.h"

namespace duet::server::config {
namespace {

using test::ParseConfigText;
using test::ResolveSettings;

constexpr auto kInvalidArgument = absl::StatusCode::kInvalidArgument;

TEST(SettingsTest, DefaultsServeTheEmbeddedCheckpointOnTheWellKnownPorts) {
  const absl::StatusOr<v1::ServerConfig> options = ResolveSettings(v1::ServerConfig(), 4);
  ASSERT_THAT(options, IsOk());
  EXPECT_EQ(options->listen(), "0.0.0.0:50051");
  EXPECT_EQ(options->metrics_listen(), "0.0.0.0:9464");
  EXPECT_TRUE(options->model_repository().empty());
  EXPECT_EQ(options->admin_listen(), "off");
  EXPECT_EQ(options->clean_up(), v1::CLEAN_UP_POLICY_AUTO);
  EXPECT_EQ(options->models(), v1::SERVED_MODELS_ALL);
  EXPECT_TRUE(options->reflection());
  EXPECT_EQ(options->workers(), 4);
  EXPECT_EQ(options->threads_per_worker(), 1);
  EXPECT_EQ(options->engine(), v1::ENGINE_CPU);
  EXPECT_EQ(options->precision(), v1::PRECISION_AUTO);
  EXPECT_EQ(options->max_request_bytes(), 32u << 20);
  EXPECT_EQ(options->max_transport_bytes(), 512u << 20);
  EXPECT_EQ(options->drain_seconds(), 0);
  EXPECT_EQ(options->grace_seconds(), 30);
  EXPECT_EQ(options->max_batch_windows(), 16);
  EXPECT_EQ(options->max_batch_delay_seconds(), 0);
  EXPECT_EQ(options->watchdog_seconds(), 120);
  EXPECT_EQ(options->log_level(), v1::LOG_LEVEL_INFO);
  EXPECT_TRUE(options->tls_certificate_file().empty());
  EXPECT_TRUE(options->access_file().empty());
}

TEST(SettingsTest, ValidValuesStayAsGiven) {
  const absl::StatusOr<v1::ServerConfig> given = ParseConfigText(
      R"(listen: "[::1]:1" metrics_listen: "off" model_repository: "/models" default_model: "sbu"
         version_labels { model: "sbu" label: "stable" version: 3 }
         tls_certificate_file: "/c" tls_key_file: "/k" tls_client_ca_file: "/a" access_file: "/l"
         log_level: LOG_LEVEL_ERROR log_refusals_per_second: 3
         admin_listen: "0.0.0.0:7" reflection: false engine: ENGINE_TORCH precision: PRECISION_F32
         workers: 2 threads_per_worker: 3 max_calls: 5 max_queued_windows: 6 max_batch_windows: 8
         max_batch_delay_seconds: 0.25 max_request_bytes: 4096 max_transport_bytes: 10000
         buffered_frames: 7 drain_seconds: 8.5 grace_seconds: 9 clean_up: CLEAN_UP_POLICY_OFF
         models: SERVED_MODELS_FREE)",
      /*json=*/false);
  ASSERT_THAT(given, IsOk());
  const absl::StatusOr<v1::ServerConfig> settings = ResolveSettings(*given, 4);
  ASSERT_THAT(settings, IsOk());
  google::protobuf::util::MessageDifferencer differencer;
  differencer.set_scope(google::protobuf::util::MessageDifferencer::PARTIAL);
  EXPECT_TRUE(differencer.Compare(*given, *settings)) << settings->DebugString();
}

TEST(SettingsTest, AddressesGetTheirNormalForm) {
  v1::ServerConfig config;
  config.set_listen(":7");
  config.set_metrics_listen("");
  const absl::StatusOr<v1::ServerConfig> settings = ResolveSettings(config, 4);
  ASSERT_THAT(settings, IsOk());
  EXPECT_EQ(settings->listen(), "0.0.0.0:7");
  EXPECT_EQ(settings->metrics_listen(), "off");
  EXPECT_EQ(settings->admin_listen(), "off");
}

TEST(SettingsTest, DefaultWorkersTimesThreadsEqualTheCores) {
  v1::ServerConfig config;
  config.set_engine(v1::ENGINE_TORCH);
  config.set_threads_per_worker(2);
  EXPECT_EQ(ResolveSettings(config, 7)->workers(), 3);
  EXPECT_EQ(ResolveSettings(config, 1)->workers(), 1);
  config.clear_threads_per_worker();
  config.set_workers(2);
  EXPECT_EQ(ResolveSettings(config, 7)->threads_per_worker(), 3);
  EXPECT_EQ(ResolveSettings(config, 1)->threads_per_worker(), 1);
}

TEST(SettingsTest, CpuEngineUsesOneThreadPerWorker) {
  v1::ServerConfig config;
  config.set_workers(2);
  EXPECT_EQ(ResolveSettings(config, 7)->threads_per_worker(), 1);
  config.set_threads_per_worker(1);
  EXPECT_THAT(ResolveSettings(config, 7), IsOk());
}

struct BadConfig {
  std::string message;
  std::function<void(v1::ServerConfig&)> spoil;
};

class BadConfigTest : public ::testing::TestWithParam<BadConfig> {};

TEST_P(BadConfigTest, IsRefusedByName) {
  v1::ServerConfig config;
  GetParam().spoil(config);
  EXPECT_THAT(ResolveSettings(config, 4),
              StatusIs(kInvalidArgument, HasSubstr(GetParam().message)));
}

INSTANTIATE_TEST_SUITE_P(
    Every, BadConfigTest,
    ::testing::Values(
        BadConfig{"listen: expected host:port", [](v1::ServerConfig& c) { c.set_listen("50051"); }},
        BadConfig{"metrics_listen: expected host:port",
                  [](v1::ServerConfig& c) { c.set_metrics_listen("a:b"); }},
        BadConfig{"workers: expected 1 to 1024, got 0",
                  [](v1::ServerConfig& c) { c.set_workers(0); }},
        BadConfig{"threads_per_worker: expected 1 with ENGINE_CPU, got 3; its",
                  [](v1::ServerConfig& c) { c.set_threads_per_worker(3); }},
        BadConfig{"engine: expected ENGINE_CPU or ENGINE_TORCH, got 0",
                  [](v1::ServerConfig& c) { c.set_engine(v1::ENGINE_UNSPECIFIED); }},
        BadConfig{"precision: expected PRECISION_AUTO, PRECISION_F32, PRECISION_BF16 or "
                  "PRECISION_INT16, got 9",
                  [](v1::ServerConfig& c) { c.set_precision(static_cast<v1::Precision>(9)); }},
        BadConfig{"precision: expected PRECISION_F32 with ENGINE_TORCH, got PRECISION_BF16",
                  [](v1::ServerConfig& c) {
                    c.set_engine(v1::ENGINE_TORCH);
                    c.set_precision(v1::PRECISION_BF16);
                  }},
        BadConfig{"watchdog_seconds: expected 0, or 1 to 86400, got 0.5",
                  [](v1::ServerConfig& c) { c.set_watchdog_seconds(0.5); }},
        BadConfig{"max_calls: expected 1 to 100000, got 0",
                  [](v1::ServerConfig& c) { c.set_max_calls(0); }},
        BadConfig{"max_request_bytes: expected 1024 to 536870912, got 4294967296",
                  [](v1::ServerConfig& c) { c.set_max_request_bytes(uint64_t{1} << 32); }},
        BadConfig{"max_transport_bytes: expected 67108864 to 1099511627776, got 67108863",
                  [](v1::ServerConfig& c) { c.set_max_transport_bytes((64 << 20) - 1); }},
        BadConfig{"grace_seconds: expected 0 to 3600, got nan",
                  [](v1::ServerConfig& c) {
                    c.set_grace_seconds(std::numeric_limits<double>::quiet_NaN());
                  }},
        BadConfig{"clean_up: expected CLEAN_UP_POLICY_AUTO",
                  [](v1::ServerConfig& c) { c.set_clean_up(v1::CLEAN_UP_POLICY_UNSPECIFIED); }},
        BadConfig{"clean_up: expected CLEAN_UP_POLICY_AUTO",
                  [](v1::ServerConfig& c) { c.set_clean_up(static_cast<v1::CleanUpPolicy>(9)); }},
        BadConfig{"models: expected SERVED_MODELS_ALL or SERVED_MODELS_FREE",
                  [](v1::ServerConfig& c) { c.set_models(v1::SERVED_MODELS_UNSPECIFIED); }},
        BadConfig{"admin_listen: expected host:port",
                  [](v1::ServerConfig& c) { c.set_admin_listen("b"); }},
        BadConfig{"tls_key_file: expected a file beside tls_certificate_file, got none",
                  [](v1::ServerConfig& c) { c.set_tls_certificate_file("/c"); }},
        BadConfig{"tls_certificate_file: expected a file beside tls_key_file, got none",
                  [](v1::ServerConfig& c) { c.set_tls_key_file("/k"); }},
        BadConfig{"tls_client_ca_file: expected tls_certificate_file",
                  [](v1::ServerConfig& c) { c.set_tls_client_ca_file("/a"); }},
        BadConfig{"version_labels[0]: expected a model, a label",
                  [](v1::ServerConfig& c) { c.add_version_labels(); }}));

TEST(SettingsTest, ReportsEveryMistake) {
  v1::ServerConfig config;
  config.set_listen("nowhere");
  config.set_max_calls(0);
  config.set_drain_seconds(-1);
  EXPECT_THAT(ResolveSettings(config, 4, {{"max_calls", "file a:1:2"}}),
              StatusIs(kInvalidArgument,
                       AllOf(HasSubstr("listen: "),
                             HasSubstr("\nmax_calls: expected 1 to 100000, got 0 (file a:1:2)\n"),
                             HasSubstr("\ndrain_seconds: expected 0 to 3600, got -1"))));
}

v1::ServerConfig Listeners(const std::string& grpc, const std::string& metrics,
                           const std::string& admin) {
  v1::ServerConfig config;
  config.set_listen(grpc);
  config.set_metrics_listen(metrics);
  config.set_admin_listen(admin);
  return config;
}

TEST(SettingsTest, RejectsListenersOnTheSamePort) {
  for (const auto& good :
       {Listeners(":1", ":2", ":3"), Listeners(":0", ":0", ":0"),
        Listeners("127.0.0.1:1", "127.0.0.2:1", "[::1]:1"), Listeners(":1", "off", ""),
        Listeners("localhost:1", "127.0.0.2:1", "")}) {
    EXPECT_THAT(ResolveSettings(good, 4), IsOk()) << good.ShortDebugString();
  }
  for (const auto& bad :
       {Listeners(":1", ":1", ""), Listeners(":1", "127.0.0.1:1", ""),
        Listeners("127.0.0.1:1", ":1", ""), Listeners("[::]:1", "10.0.0.1:1", ""),
        Listeners("localhost:1", "127.0.0.1:1", ""), Listeners("[::1]:1", "localhost:1", "")}) {
    EXPECT_THAT(ResolveSettings(bad, 4),
                StatusIs(kInvalidArgument,
                         AllOf(HasSubstr("metrics_listen: expected another port than listen, got "),
                               HasSubstr("; listen is "))))
        << bad.ShortDebugString();
  }
  EXPECT_THAT(
      ResolveSettings(Listeners(":9464", "", ":9464"), 4, {{"admin_listen", "command line"}}),
      StatusIs(kInvalidArgument,
               "admin_listen: expected another port than listen, got 0.0.0.0:9464 (command "
               "line); listen is 0.0.0.0:9464; port 0 is any free one, \"off\" none"));
  EXPECT_THAT(
      ResolveSettings(Listeners(":7", ":7", ":7"), 4),
      StatusIs(kInvalidArgument,
               AllOf(HasSubstr("metrics_listen: expected another port than listen"),
                     HasSubstr("\nadmin_listen: expected another port than listen"),
                     HasSubstr("\nadmin_listen: expected another port than metrics_listen"))));
  v1::ServerConfig only_grpc;
  only_grpc.set_listen("0.0.0.0:9464");
  EXPECT_THAT(ResolveSettings(only_grpc, 4),
              StatusIs(kInvalidArgument, HasSubstr("metrics_listen: ")))
      << "the default";
}

TEST(SettingsTest, RejectsAClientKeyThatMetadataCannotHold) {
  v1::ServerConfig config;
  config.set_client_key("x-client_1.a");
  EXPECT_THAT(ResolveSettings(config, 4), IsOk());
  for (const char* bad : {"X-Client", "x client", "x:client", "client-bin"}) {
    config.set_client_key(bad);
    EXPECT_THAT(ResolveSettings(config, 4),
                StatusIs(kInvalidArgument, HasSubstr("client_key: expected")));
  }
}

TEST(SettingsTest, RejectsMoreThreadsThanTheCoresCanUse) {
  v1::ServerConfig config;
  config.set_workers(33);
  EXPECT_THAT(ResolveSettings(config, 2),
              StatusIs(kInvalidArgument, "workers: expected 1 to 32 on 2 cores, got 33"));
  EXPECT_THAT(ResolveSettings(config, 9), IsOk());
  config.set_engine(v1::ENGINE_TORCH);
  config.set_workers(2);
  config.set_threads_per_worker(1024);
  EXPECT_THAT(ResolveSettings(config, 2),
              StatusIs(kInvalidArgument,
                       "threads_per_worker: expected 1 to 16 with 2 workers, got 1024; together "
                       "they may have 32 threads on 2 cores"));
  config.set_threads_per_worker(16);
  EXPECT_THAT(ResolveSettings(config, 2), IsOk());
}

}  // namespace
}  // namespace duet::server::config

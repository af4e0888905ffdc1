#include "server/config/server_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "tests/support/status_matchers.h"

namespace duet::server::config {
namespace {

using test::IsOk;
using test::StatusIs;

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr auto kInvalidArgument = absl::StatusCode::kInvalidArgument;

TEST(ServerOptionsTest, DefaultsServeTheEmbeddedCheckpointOnTheWellKnownPorts) {
  const absl::StatusOr<ServerOptions> options = ToOptions(v1::ServerConfig(), 4);
  ASSERT_THAT(options, IsOk());
  EXPECT_EQ(ToString(options->listen), "0.0.0.0:50051");
  ASSERT_TRUE(options->metrics_listen.has_value());
  EXPECT_EQ(ToString(*options->metrics_listen), "0.0.0.0:9464");
  EXPECT_TRUE(options->model_repository.empty());
  EXPECT_FALSE(options->admin_listen.has_value());
  EXPECT_TRUE(options->reflection);
  EXPECT_EQ(options->workers, 4);
  EXPECT_EQ(options->engine.threads, 1);
  EXPECT_EQ(options->engine.engine, EngineOptions::Engine::kCpu);
  EXPECT_EQ(options->engine.precision, EngineOptions::Precision::kAuto);
  EXPECT_EQ(options->max_request_bytes, 32u << 20);
  EXPECT_EQ(options->max_transport_bytes, 512u << 20);
  EXPECT_EQ(options->drain_seconds, 0);
  EXPECT_EQ(options->grace_seconds, 30);
  EXPECT_EQ(options->max_batch_windows, 16);
  EXPECT_EQ(options->max_batch_delay_seconds, 0);
}

TEST(ServerOptionsTest, TakesOverEveryField) {
  v1::ServerConfig config;
  config.set_listen("[::1]:1");
  config.set_metrics_listen("off");
  config.set_model_repository("/models");
  config.set_default_model("sbu");
  v1::VersionLabel& label = *config.add_version_labels();
  label.set_model("sbu");
  label.set_label("stable");
  label.set_version(3);
  config.add_version_policies()->set_model("sbu");
  config.mutable_version_policies(0)->set_latest(2);
  config.add_version_policies()->set_model("*");
  for (const uint32_t version : {1u, 3u}) config.mutable_version_policies(1)->add_versions(version);
  config.set_admin_listen(":7");
  config.set_reflection(false);
  config.set_engine(v1::ENGINE_TORCH);
  config.set_precision(v1::PRECISION_F32);
  config.set_workers(2);
  config.set_threads_per_worker(3);
  config.set_max_calls(5);
  config.set_max_queued_windows(6);
  config.set_max_batch_windows(8);
  config.set_max_batch_delay_seconds(0.25);
  config.set_max_request_bytes(4096);
  config.set_max_transport_bytes(10000);
  config.set_buffered_frames(7);
  config.set_drain_seconds(8.5);
  config.set_grace_seconds(9);
  config.set_clean_up(v1::CLEAN_UP_POLICY_OFF);
  const absl::StatusOr<ServerOptions> options = ToOptions(config, 4);
  ASSERT_THAT(options, IsOk());
  EXPECT_EQ(ToString(options->listen), "[::1]:1");
  EXPECT_FALSE(options->metrics_listen.has_value());
  EXPECT_EQ(options->model_repository, "/models");
  EXPECT_EQ(options->default_model, "sbu");
  ASSERT_EQ(options->version_labels.size(), 1u);
  EXPECT_EQ(options->version_labels[0].model, "sbu");
  EXPECT_EQ(options->version_labels[0].label, "stable");
  EXPECT_EQ(options->version_labels[0].version, 3u);
  ASSERT_EQ(options->version_policies.size(), 2u);
  EXPECT_EQ(options->version_policies[0].model, "sbu");
  EXPECT_EQ(options->version_policies[0].latest, 2u);
  EXPECT_EQ(options->version_policies[1].model, "");
  EXPECT_EQ(options->version_policies[1].versions, std::vector<uint32_t>({1, 3}));
  EXPECT_EQ(ToString(*options->admin_listen), "0.0.0.0:7");
  EXPECT_FALSE(options->reflection);
  EXPECT_EQ(options->workers, 2);
  EXPECT_EQ(options->engine.threads, 3);
  EXPECT_EQ(options->engine.engine, EngineOptions::Engine::kTorch);
  EXPECT_EQ(options->engine.precision, EngineOptions::Precision::kFloat32);
  EXPECT_EQ(options->max_calls, 5);
  EXPECT_EQ(options->max_queued_windows, 6);
  EXPECT_EQ(options->max_batch_windows, 8);
  EXPECT_EQ(options->max_batch_delay_seconds, 0.25);
  EXPECT_EQ(options->max_request_bytes, 4096u);
  EXPECT_EQ(options->max_transport_bytes, 10000u);
  EXPECT_EQ(options->buffered_frames, 7);
  EXPECT_EQ(options->drain_seconds, 8.5);
  EXPECT_EQ(options->grace_seconds, 9);
  EXPECT_EQ(options->clean_up, false);
}

TEST(ServerOptionsTest, CleansUpAsTheModelHasItUnlessToldOtherwise) {
  v1::ServerConfig config;
  EXPECT_EQ(ToOptions(config, 4)->clean_up, std::nullopt);
  config.set_clean_up(v1::CLEAN_UP_POLICY_AUTO);
  EXPECT_EQ(ToOptions(config, 4)->clean_up, std::nullopt);
  config.set_clean_up(v1::CLEAN_UP_POLICY_ON);
  EXPECT_EQ(ToOptions(config, 4)->clean_up, true);
}

TEST(ServerOptionsTest, AnEmptyMetricsAddressTurnsMetricsOffAsWell) {
  v1::ServerConfig config;
  config.set_metrics_listen("");
  EXPECT_FALSE(ToOptions(config, 4)->metrics_listen.has_value());
}

TEST(ServerOptionsTest, WorkersTimesThreadsUseTheCoresAndNoMore) {
  v1::ServerConfig config;
  config.set_engine(v1::ENGINE_TORCH);
  config.set_threads_per_worker(2);
  EXPECT_EQ(ToOptions(config, 7)->workers, 3);
  EXPECT_EQ(ToOptions(config, 1)->workers, 1);
  config.clear_threads_per_worker();
  config.set_workers(2);
  EXPECT_EQ(ToOptions(config, 7)->engine.threads, 3);
  EXPECT_EQ(ToOptions(config, 1)->engine.threads, 1);
}

TEST(ServerOptionsTest, EvaluationsOfTheCpuEngineHaveOneThreadEach) {
  v1::ServerConfig config;
  config.set_workers(2);
  EXPECT_EQ(ToOptions(config, 7)->engine.threads, 1);
  config.set_threads_per_worker(1);
  EXPECT_THAT(ToOptions(config, 7), IsOk());
}

struct BadConfig {
  std::string message;
  std::function<void(v1::ServerConfig&)> spoil;
};

class BadConfigTest : public ::testing::TestWithParam<BadConfig> {};

TEST_P(BadConfigTest, IsRefusedByName) {
  v1::ServerConfig config;
  GetParam().spoil(config);
  EXPECT_THAT(ToOptions(config, 4), StatusIs(kInvalidArgument, HasSubstr(GetParam().message)));
}

INSTANTIATE_TEST_SUITE_P(Every, BadConfigTest,
                         ::testing::
                             Values(BadConfig{"listen: is \"50051\", wanted host:port",
                                              [](v1::ServerConfig& c) { c.set_listen("50051"); }},
                                    BadConfig{
                                        "metrics_listen: is \"a:b\", wanted host:port",
                                        [](v1::ServerConfig& c) { c.set_metrics_listen("a:b"); }},
                                    BadConfig{"workers: is 0, wanted 1 to 1024",
                                              [](v1::ServerConfig& c) { c.set_workers(0); }},
                                    BadConfig{"threads_per_worker: is 5000, wanted 1 to 1024",
                                              [](v1::ServerConfig& c) {
                                                c.set_threads_per_worker(5000);
                                              }},
                                    BadConfig{
                                        "threads_per_worker: is 3, wanted 1 with ENGINE_CPU",
                                        [](v1::ServerConfig& c) { c.set_threads_per_worker(3); }},
                                    BadConfig{"engine: is 0, wanted ENGINE_CPU or ENGINE_TORCH",
                                              [](v1::ServerConfig& c) {
                                                c.set_engine(v1::ENGINE_UNSPECIFIED);
                                              }},
                                    BadConfig{"precision: is 9, wanted PRECISION_AUTO, "
                                              "PRECISION_F32 or PRECISION_BF16",
                                              [](v1::ServerConfig& c) {
                                                c.set_precision(static_cast<v1::Precision>(9));
                                              }},
                                    BadConfig{"precision: is PRECISION_BF16, wanted PRECISION_F32 "
                                              "with ENGINE_TORCH",
                                              [](v1::ServerConfig& c) {
                                                c.set_engine(v1::ENGINE_TORCH);
                                                c.set_precision(v1::PRECISION_BF16);
                                              }},
                                    BadConfig{"max_calls: is 0, wanted 1",
                                              [](v1::ServerConfig& c) { c.set_max_calls(0); }},
                                    BadConfig{
                                        "max_queued_windows: is 0, wanted 1",
                                        [](v1::ServerConfig& c) { c.set_max_queued_windows(0); }},
                                    BadConfig{
                                        "max_batch_windows: is 0, wanted 1 to 1024",
                                        [](v1::ServerConfig& c) { c.set_max_batch_windows(0); }},
                                    BadConfig{
                                        "max_batch_windows: is 1025, wanted 1 to 1024",
                                        [](v1::ServerConfig& c) { c.set_max_batch_windows(1025); }},
                                    BadConfig{"max_batch_delay_seconds: is -0.5, wanted 0 to 1",
                                              [](v1::ServerConfig& c) {
                                                c.set_max_batch_delay_seconds(-0.5);
                                              }},
                                    BadConfig{"max_batch_delay_seconds: is 1.5, wanted 0 to 1",
                                              [](v1::ServerConfig& c) {
                                                c.set_max_batch_delay_seconds(1.5);
                                              }},
                                    BadConfig{
                                        "max_request_bytes: is 10, wanted 1024",
                                        [](v1::ServerConfig& c) { c.set_max_request_bytes(10); }},
                                    BadConfig{"max_request_bytes: is 4294967296, wanted 1024",
                                              [](v1::ServerConfig& c) {
                                                c.set_max_request_bytes(uint64_t{1} << 32);
                                              }},
                                    BadConfig{
                                        "max_request_bytes: is 536870913, wanted 1024 to 536870912",
                                        [](v1::ServerConfig& c) {
                                          c.set_max_request_bytes((uint64_t{1} << 29) + 1);
                                        }},
                                    BadConfig{
                                        "max_transport_bytes: is 67108863, wanted 67108864 to",
                                        [](v1::ServerConfig& c) {
                                          c.set_max_transport_bytes((64 << 20) - 1);
                                        }},
                                    BadConfig{
                                        "buffered_frames: is 0, wanted 1",
                                        [](v1::ServerConfig& c) { c.set_buffered_frames(0); }},
                                    BadConfig{"drain_seconds: is -1, wanted 0 to 3600",
                                              [](v1::ServerConfig& c) { c.set_drain_seconds(-1); }},
                                    BadConfig{"grace_seconds: is nan, wanted 0 to 3600",
                                              [](v1::ServerConfig& c) {
                                                c.set_grace_seconds(
                                                    std::numeric_limits<double>::quiet_NaN());
                                              }},
                                    BadConfig{"clean_up: is 0, wanted CLEAN_UP_POLICY_AUTO",
                                              [](v1::ServerConfig& c) {
                                                c.set_clean_up(v1::CLEAN_UP_POLICY_UNSPECIFIED);
                                              }},
                                    BadConfig{"clean_up: is 9, wanted CLEAN_UP_POLICY_AUTO",
                                              [](v1::ServerConfig& c) {
                                                c.set_clean_up(static_cast<v1::CleanUpPolicy>(9));
                                              }},
                                    BadConfig{"admin_listen: is \"b\", wanted host:port",
                                              [](v1::ServerConfig& c) { c.set_admin_listen("b"); }},
                                    BadConfig{
                                        "version_policies[0]: has no model",
                                        [](v1::ServerConfig& c) { c.add_version_policies(); }},
                                    BadConfig{"version_policies[1]: is the second of model \"a\"",
                                              [](v1::ServerConfig& c) {
                                                c.add_version_policies()->set_model("a");
                                                c.add_version_policies()->set_model("a");
                                              }},
                                    BadConfig{"version_policies[0]: has both latest and versions",
                                              [](v1::ServerConfig& c) {
                                                c.add_version_policies()->set_model("a");
                                                c.mutable_version_policies(0)->set_latest(1);
                                                c.mutable_version_policies(0)->add_versions(1);
                                              }},
                                    BadConfig{"version_policies[0]: has a 0",
                                              [](v1::ServerConfig& c) {
                                                c.add_version_policies()->set_model("*");
                                                c.mutable_version_policies(0)->set_latest(0);
                                              }},
                                    BadConfig{
                                        "version_labels[0]: is model \"\"",
                                        [](v1::ServerConfig& c) { c.add_version_labels(); }}));

TEST(ServerOptionsTest, TellsEveryFieldThatIsWrong) {
  v1::ServerConfig config;
  config.set_listen("nowhere");
  config.set_max_calls(0);
  config.set_drain_seconds(-1);
  EXPECT_THAT(ToOptions(config, 4, {{"max_calls", "file a:1:2"}}),
              StatusIs(kInvalidArgument,
                       AllOf(HasSubstr("listen: "),
                             HasSubstr("\nmax_calls: is 0, wanted 1 to 100000 (file a:1:2)\n"),
                             HasSubstr("\ndrain_seconds: is -1"))));
}

TEST(ServerOptionsTest, RefusesMoreThreadsThanCoresCanMakeUseOf) {
  v1::ServerConfig config;
  config.set_workers(33);
  EXPECT_THAT(ToOptions(config, 2),
              StatusIs(kInvalidArgument, "workers: is 33, wanted 1 to 32 on 2 cores"));
  EXPECT_THAT(ToOptions(config, 9), IsOk());
  config.set_engine(v1::ENGINE_TORCH);
  config.set_workers(2);
  config.set_threads_per_worker(1024);
  EXPECT_THAT(ToOptions(config, 2),
              StatusIs(kInvalidArgument,
                       "threads_per_worker: is 1024, wanted 1 to 16 with 2 workers: together at "
                       "most 32 threads on 2 cores"));
  config.set_threads_per_worker(16);
  EXPECT_THAT(ToOptions(config, 2), IsOk());
}

TEST(ListenAddressTest, ReadsHostAndPort) {
  for (const char* text : {"0.0.0.0:50051", "localhost:0", "[::]:9464", "10.1.2.3:65535"}) {
    const absl::StatusOr<ListenAddress> address = ParseListenAddress(text);
    ASSERT_THAT(address, IsOk()) << text;
    EXPECT_EQ(ToString(*address), text);
  }
  EXPECT_EQ(ToString(*ParseListenAddress(":80")), "0.0.0.0:80");
}

TEST(ListenAddressTest, RefusesAnythingElse) {
  for (const char* text : {"", "localhost", "localhost:", "localhost:-1", "localhost:65536",
                           "localhost:http", "::1:80", "[::1]", "[::1:80"}) {
    EXPECT_THAT(ParseListenAddress(text), StatusIs(kInvalidArgument, HasSubstr("host:port")))
        << text;
  }
}

}  // namespace
}  // namespace duet::server::config

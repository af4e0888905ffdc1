// The settings of certificates, callers, log and traces.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>

#include "server/config/settings.h"
#include "tests/support/matchers.h"

namespace duet::server::config {
namespace {

TEST(SecuritySettingsTest, DefaultsAreUnencryptedAndUntraced) {
  const absl::StatusOr<v1::ServerConfig> options = ResolveSettings(v1::ServerConfig(), 4);
  ASSERT_THAT(options, IsOk());
  EXPECT_TRUE(options->tls_certificate_file().empty());
  EXPECT_TRUE(options->access_file().empty());
  EXPECT_EQ(options->log_format(), v1::LOG_FORMAT_JSON);
  EXPECT_EQ(options->log_level(), v1::LOG_LEVEL_INFO);
  EXPECT_EQ(options->log_success_ratio(), 1);
  EXPECT_EQ(options->log_refusals_per_second(), 10);
  EXPECT_TRUE(options->otlp_endpoint().empty());
  EXPECT_EQ(options->trace_ratio(), 1);
}

TEST(SecuritySettingsTest, ValidValuesStayAsGiven) {
  v1::ServerConfig config;
  config.set_tls_certificate_file("/c");
  config.set_tls_key_file("/k");
  config.set_tls_client_ca_file("/a");
  config.set_access_file("/l");
  config.set_otlp_endpoint("http://o:1");
  config.set_trace_ratio(0.25);
  config.set_log_format(v1::LOG_FORMAT_TEXT);
  config.set_log_level(v1::LOG_LEVEL_ERROR);
  config.set_log_success_ratio(0.5);
  config.set_log_refusals_per_second(3);
  const absl::StatusOr<v1::ServerConfig> options = ResolveSettings(config, 4);
  ASSERT_THAT(options, IsOk());
  EXPECT_EQ(options->tls_certificate_file(), "/c");
  EXPECT_EQ(options->tls_key_file(), "/k");
  EXPECT_EQ(options->tls_client_ca_file(), "/a");
  EXPECT_EQ(options->access_file(), "/l");
  EXPECT_EQ(options->log_format(), v1::LOG_FORMAT_TEXT);
  EXPECT_EQ(options->log_level(), v1::LOG_LEVEL_ERROR);
  EXPECT_EQ(options->log_success_ratio(), 0.5);
  EXPECT_EQ(options->log_refusals_per_second(), 3);
  EXPECT_EQ(options->otlp_endpoint(), "http://o:1");
  EXPECT_EQ(options->trace_ratio(), 0.25);
  config.set_log_level(v1::LOG_LEVEL_WARNING);
  config.set_log_format(v1::LOG_FORMAT_JSON);
  EXPECT_EQ(ResolveSettings(config, 4)->log_level(), v1::LOG_LEVEL_WARNING);
  EXPECT_EQ(ResolveSettings(config, 4)->log_format(), v1::LOG_FORMAT_JSON);
}

struct BadConfig {
  std::string message;
  std::function<void(v1::ServerConfig&)> spoil;
};

class BadSecurityTest : public ::testing::TestWithParam<BadConfig> {};

TEST_P(BadSecurityTest, ErrorNamesTheField) {
  v1::ServerConfig config;
  GetParam().spoil(config);
  EXPECT_THAT(ResolveSettings(config, 4),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr(GetParam().message)));
}

INSTANTIATE_TEST_SUITE_P(
    Every, BadSecurityTest,
    ::testing::Values(
        BadConfig{"tls_key_file: expected a file beside tls_certificate_file, got none",
                  [](v1::ServerConfig& c) { c.set_tls_certificate_file("/c"); }},
        BadConfig{"tls_certificate_file: expected a file beside tls_key_file, got none",
                  [](v1::ServerConfig& c) { c.set_tls_key_file("/k"); }},
        BadConfig{"tls_client_ca_file: expected tls_certificate_file",
                  [](v1::ServerConfig& c) { c.set_tls_client_ca_file("/a"); }},
        BadConfig{"log_format: expected LOG_FORMAT_JSON or LOG_FORMAT_TEXT, got 0",
                  [](v1::ServerConfig& c) { c.set_log_format(v1::LOG_FORMAT_UNSPECIFIED); }},
        BadConfig{"log_level: expected LOG_LEVEL_INFO, LOG_LEVEL_WARNING or LOG_LEVEL_ERROR, got 0",
                  [](v1::ServerConfig& c) { c.set_log_level(v1::LOG_LEVEL_UNSPECIFIED); }},
        BadConfig{"log_level: expected LOG_LEVEL_INFO, LOG_LEVEL_WARNING or LOG_LEVEL_ERROR, got 9",
                  [](v1::ServerConfig& c) { c.set_log_level(static_cast<v1::LogLevel>(9)); }},
        BadConfig{"log_success_ratio: expected 0 to 1, got 1.5",
                  [](v1::ServerConfig& c) { c.set_log_success_ratio(1.5); }},
        BadConfig{"log_refusals_per_second: expected 0 to 1000000, got 1000001",
                  [](v1::ServerConfig& c) { c.set_log_refusals_per_second(1000001); }},
        BadConfig{"otlp_endpoint: expected http://HOST:PORT or https://HOST:PORT, got "
                  "\"ftp://x\"",
                  [](v1::ServerConfig& c) { c.set_otlp_endpoint("ftp://x"); }},
        BadConfig{"trace_ratio: expected 0 to 1, got 1.0000001",
                  [](v1::ServerConfig& c) { c.set_trace_ratio(1.0000001); }},
        BadConfig{"trace_ratio: expected 0 to 1, got nan", [](v1::ServerConfig& c) {
                    c.set_trace_ratio(std::numeric_limits<double>::quiet_NaN());
                  }}));

}  // namespace
}  // namespace duet::server::config

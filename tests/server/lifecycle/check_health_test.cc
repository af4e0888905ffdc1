#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/lifecycle/self_check.h"
#include "server/metrics/metrics_endpoint.h"
#include "tests/server/support/running_service.h"
#include "tests/support/matchers.h"

namespace duet::server::lifecycle {
namespace {

using absl::StatusCode;

constexpr double kPatience = 60;

std::unique_ptr<metrics::MetricsEndpoint> Endpoint(bool healthy) {
  metrics::MetricsEndpointOptions options;
  options.host = "127.0.0.1";
  options.render = [] { return std::string(); };
  options.healthy = [healthy] { return healthy; };
  options.ready = [] { return false; };  // such as while it drains
  auto endpoint = metrics::MetricsEndpoint::Start(std::move(options));
  EXPECT_THAT(endpoint.status(), IsOk());
  return *std::move(endpoint);
}

v1::ServerConfig Settings(const std::string& metrics_listen) {
  v1::ServerConfig settings;
  settings.set_metrics_listen(metrics_listen);
  return settings;
}

TEST(CheckHealthTest, HealthyServerPassesAlsoWhileItIsNotReady) {
  const auto endpoint = Endpoint(/*healthy=*/true);
  EXPECT_THAT(CheckHealth(Settings(absl::StrCat("127.0.0.1:", endpoint->port())), kPatience),
              IsOk());
}

TEST(CheckHealthTest, ErrorShowsTheStatusOfAnUnhealthyServer) {
  const auto endpoint = Endpoint(/*healthy=*/false);
  EXPECT_THAT(CheckHealth(Settings(absl::StrCat("127.0.0.1:", endpoint->port())), kPatience),
              StatusIs(StatusCode::kUnavailable, HasSubstr("HTTP/1.1 503 ")));
}

TEST(CheckHealthTest, ServerThatIsGoneFails) {
  const int port = Endpoint(/*healthy=*/true)->port();
  EXPECT_THAT(CheckHealth(Settings(absl::StrCat("127.0.0.1:", port)), kPatience),
              StatusIs(StatusCode::kUnavailable, HasSubstr("cannot connect")));
}

TEST(CheckHealthTest, WithoutMetricsTheServersPortIsChecked) {
  test::RunningService running;
  v1::ServerConfig settings = Settings("off");
  settings.set_listen(running.address());
  EXPECT_THAT(CheckHealth(settings, kPatience), IsOk());
}

}  // namespace
}  // namespace duet::server::lifecycle

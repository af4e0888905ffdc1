#include "server/metrics/metrics_endpoint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <string>
#include <utility>

#include "tests/server/support/http_get.h"
#include "tests/support/status_matchers.h"

namespace duet::server::metrics {
namespace {

using test::Exchange;
using test::HttpGet;
using test::IsOk;
using test::StatusIs;

using ::testing::HasSubstr;
using ::testing::StartsWith;

class MetricsEndpointTest : public ::testing::Test {
 protected:
  MetricsEndpointTest() {
    MetricsEndpointOptions options;
    options.host = "127.0.0.1";
    options.render = [] { return std::string("duet_frames_total 7\n"); };
    options.ready = [this] { return ready_.load(); };
    absl::StatusOr<std::unique_ptr<MetricsEndpoint>> endpoint =
        MetricsEndpoint::Start(std::move(options));
    EXPECT_THAT(endpoint, IsOk());
    endpoint_ = *std::move(endpoint);
  }

  std::string Get(const std::string& path) { return HttpGet(endpoint_->port(), path); }

  std::atomic<bool> ready_{false};
  std::unique_ptr<MetricsEndpoint> endpoint_;
};

TEST_F(MetricsEndpointTest, ServesMetricsAsPrometheusWantsThem) {
  const std::string response = Get("/metrics");
  EXPECT_THAT(response, StartsWith("HTTP/1.1 200 OK"));
  EXPECT_THAT(response, HasSubstr("Content-Type: text/plain; version=0.0.4"));
  EXPECT_THAT(response, HasSubstr("\r\n\r\nduet_frames_total 7\n"));
}

TEST_F(MetricsEndpointTest, IsHealthyWheneverItAnswers) {
  EXPECT_THAT(Get("/healthz"), StartsWith("HTTP/1.1 200 OK"));
}

TEST_F(MetricsEndpointTest, IsReadyWhileCallsAreServed) {
  EXPECT_THAT(Get("/readyz"), StartsWith("HTTP/1.1 503"));
  ready_ = true;
  EXPECT_THAT(Get("/readyz"), StartsWith("HTTP/1.1 200 OK"));
}

TEST_F(MetricsEndpointTest, HasNothingElse) {
  EXPECT_THAT(Get("/"), StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(Get("/../etc/passwd"), StartsWith("HTTP/1.1 404"));
}

TEST_F(MetricsEndpointTest, RefusesWhatIsNoRequest) {
  EXPECT_THAT(Exchange(endpoint_->port(), "\x16\x03\x01 nonsense\r\n\r\n"),
              StartsWith("HTTP/1.1 400"));
  EXPECT_THAT(Exchange(endpoint_->port(),
                       "POST /metrics HTTP/1.1\r\nHost: a\r\nContent-Length: 5\r\n\r\nhello"),
              StartsWith("HTTP/1.1 4"));
}

TEST_F(MetricsEndpointTest, ASecondOneOnThePortFailsAndSaysWhere) {
  MetricsEndpointOptions options;
  options.host = "127.0.0.1";
  options.port = endpoint_->port();
  EXPECT_THAT(MetricsEndpoint::Start(std::move(options)),
              StatusIs(absl::StatusCode::kUnavailable,
                       HasSubstr("127.0.0.1:" + std::to_string(endpoint_->port()))));
}

}  // namespace
}  // namespace duet::server::metrics

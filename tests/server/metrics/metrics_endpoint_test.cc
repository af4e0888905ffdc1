#include "server/metrics/metrics_endpoint.h"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <deque>
#include <memory>
#include <string>
#include <utility>

#include "tests/server/support/raw_call.h"
#include "tests/support/matchers.h"

namespace duet::server::metrics {
namespace {

using test::Exchange;
using test::HttpGet;

class MetricsEndpointTest : public ::testing::Test {
 protected:
  MetricsEndpointTest() {
    MetricsEndpointOptions options;
    options.host = "127.0.0.1";
    options.render = [this] { return text_; };
    options.healthy = [this] { return healthy_.load(); };
    options.ready = [this] { return ready_.load(); };
    absl::StatusOr<std::unique_ptr<MetricsEndpoint>> endpoint =
        MetricsEndpoint::Start(std::move(options));
    EXPECT_THAT(endpoint, IsOk());
    endpoint_ = *std::move(endpoint);
  }

  std::string Get(const std::string& path) { return HttpGet(endpoint_->port(), path); }

  std::string text_ = "duet_frames_total 7\n";  // not changed while it is asked for
  std::atomic<bool> healthy_{true};
  std::atomic<bool> ready_{false};
  std::unique_ptr<MetricsEndpoint> endpoint_;
};

TEST_F(MetricsEndpointTest, ServesMetricsInThePrometheusFormat) {
  const std::string response = Get("/metrics");
  EXPECT_THAT(response, StartsWith("HTTP/1.1 200 OK"));
  EXPECT_THAT(response, HasSubstr("Content-Type: text/plain; version=0.0.4"));
  EXPECT_THAT(response, HasSubstr("\r\n\r\nduet_frames_total 7\n"));
}

TEST_F(MetricsEndpointTest, ReportsHealthAndReadiness) {
  EXPECT_THAT(Get("/healthz"), StartsWith("HTTP/1.1 200 OK"));
  EXPECT_THAT(Get("/readyz"), StartsWith("HTTP/1.1 503"));
  healthy_ = false;
  ready_ = true;
  EXPECT_THAT(Get("/healthz"), StartsWith("HTTP/1.1 503"));
  EXPECT_THAT(Get("/readyz"), StartsWith("HTTP/1.1 200 OK"));
}

// A client that connects and sends an incomplete request.
class Loiterer {
 public:
  Loiterer(int port, const std::string& words) : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address = {};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
    EXPECT_EQ(send(socket_, words.data(), words.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(words.size()));
  }
  ~Loiterer() { close(socket_); }
  Loiterer(const Loiterer&) = delete;
  Loiterer& operator=(const Loiterer&) = delete;

  // Waits for data or the end of the connection. Returns whether the connection has ended.
  bool IsSentAway() const {
    char byte = 0;
    return recv(socket_, &byte, 1, 0) <= 0;
  }

 private:
  const int socket_;
};

TEST_F(MetricsEndpointTest, SlowClientsDoNotDelayOthers) {
  std::deque<Loiterer> loiterers;
  for (const char* words : {"", "G", "GET /metr", "GET /healthz HTTP/1.1\r\n", "", "G"}) {
    loiterers.emplace_back(endpoint_->port(), words);
  }
  for (const char* path : {"/healthz", "/metrics"}) {
    EXPECT_THAT(Get(path), StartsWith("HTTP/1.1 200 OK"));
  }
}

TEST(MetricsEndpointTimeTest, IdleConnectionEnds) {
  MetricsEndpointOptions options;
  options.host = "127.0.0.1";
  options.idle_seconds = 0.01;
  absl::StatusOr<std::unique_ptr<MetricsEndpoint>> endpoint =
      MetricsEndpoint::Start(std::move(options));
  ASSERT_THAT(endpoint, IsOk());
  const Loiterer loiterer((*endpoint)->port(), "");
  EXPECT_TRUE(loiterer.IsSentAway());
}

TEST_F(MetricsEndpointTest, LongReplyArrivesCompletely) {
  text_ = std::string(2'000'000, 'x');
  const std::string response = Get("/metrics");
  const std::size_t body = response.find("\r\n\r\n") + 4;
  ASSERT_EQ(response.size(), body + text_.size());
  EXPECT_TRUE(response.compare(body, text_.size(), text_) == 0);
}

TEST_F(MetricsEndpointTest, HeadReplyHasTheLengthWithoutTheBody) {
  const std::string reply = Exchange(endpoint_->port(), "HEAD /healthz HTTP/1.1\r\n\r\n");
  EXPECT_THAT(reply, HasSubstr("Content-Length: 3\r\n"));
  EXPECT_THAT(reply, EndsWith("\r\n\r\n"));
}

TEST_F(MetricsEndpointTest, AnswersWithTheMatchingCode) {
  const std::pair<std::string, const char*> cases[] = {
      {"GET /healthz HTTP/1.0\r\n\r\n", "200 OK"},
      {"GET /healthz?name[]=duet HTTP/1.1\r\n\r\n", "200 OK"},
      {"GET /other HTTP/1.1\r\n\r\n", "404 Not Found"},
      {"GET * HTTP/1.1\r\n\r\n", "404 Not Found"},
      {"POST /healthz HTTP/1.1\r\n\r\n", "501 Not Implemented"},
      {"GET /healthz HTTP/2.0\r\n\r\n", "400 Bad Request"},
      {"\x16\x03 x HTTP/1.1\r\n\r\n", "400 Bad Request"},
      {"\r\n\r\n", "400 Bad Request"},
      {std::string(9000, 'x'), "400 Bad Request"}};
  for (const auto& [request, status] : cases) {
    EXPECT_THAT(Exchange(endpoint_->port(), request), HasSubstr(status)) << request;
  }
}

}  // namespace
}  // namespace duet::server::metrics

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
    options.max_connections = 8;
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

TEST_F(MetricsEndpointTest, NewConnectionReplacesTheOldest) {
  std::deque<Loiterer> loiterers;
  for (int i = 0; i < 9; ++i) loiterers.emplace_back(endpoint_->port(), "");
  EXPECT_TRUE(loiterers.front().IsSentAway());
  EXPECT_THAT(Get("/healthz"), StartsWith("HTTP/1.1 200 OK"));
}

TEST(MetricsEndpointTimeTest, ConnectionEndsAtItsMaximumDuration) {
  MetricsEndpointOptions options;
  options.host = "127.0.0.1";
  options.connection_seconds = 0.01;
  absl::StatusOr<std::unique_ptr<MetricsEndpoint>> endpoint =
      MetricsEndpoint::Start(std::move(options));
  ASSERT_THAT(endpoint, IsOk());
  const Loiterer loiterer((*endpoint)->port(), "");
  EXPECT_TRUE(loiterer.IsSentAway());
}

TEST_F(MetricsEndpointTest, LongReplyArrivesCompletely) {
  text_ = std::string(20'000'000, 'x');
  const std::string response = Get("/metrics");
  const std::size_t body = response.find("\r\n\r\n") + 4;
  ASSERT_EQ(response.size(), body + text_.size());
  EXPECT_TRUE(response.compare(body, text_.size(), text_) == 0);
}

const HttpPages& Pages() {
  static const auto* const pages = new HttpPages{{"/page", [] {
                                                    return HttpPage{true, "text/plain", "hello\n"};
                                                  }}};
  return *pages;
}

std::string Reply(const std::string& request) { return HttpReply(request, Pages()).value_or(""); }

TEST(HttpReplyTest, WaitsForTheEndOfTheHead) {
  const std::string request = "GET /page HTTP/1.1\r\nHost: a\r\n\r\n";
  for (std::size_t i = 0; i < request.size(); ++i) {
    EXPECT_FALSE(HttpReply(request.substr(0, i), Pages()).has_value()) << i;
  }
  EXPECT_EQ(Reply(request),
            "HTTP/1.1 200 OK\r\nContent-Type: text/plain\r\nContent-Length: 6\r\n"
            "Connection: close\r\n\r\nhello\n");
}

TEST(HttpReplyTest, HeadReplyHasTheLengthWithoutTheBody) {
  const std::string reply = Reply("HEAD /page HTTP/1.1\r\n\r\n");
  EXPECT_THAT(reply, HasSubstr("Content-Length: 6\r\n"));
  EXPECT_THAT(reply, Not(HasSubstr("hello")));
}

TEST(HttpReplyTest, AnswersWithTheMatchingCode) {
  const std::pair<const char*, const char*> cases[] = {
      {"GET /page HTTP/1.1\r\nContent-Length: 99\r\n\r\nab", "200 OK"},  // bodies are not read
      {"GET /page?name[]=duet HTTP/1.0\r\n\r\n", "200 OK"},
      {"GET /other HTTP/1.1\r\n\r\n", "404 Not Found"},
      {"GET /pag HTTP/1.1\r\n\r\n", "404 Not Found"},
      {"POST /page HTTP/1.1\r\n\r\n", "405 Method Not Allowed"},
      {"\x16\x03 x HTTP/1.1\r\n\r\n", "405 Method Not Allowed"},
      {"GET /page HTTP/2.0\r\n\r\n", "400 Bad Request"},
      {"GET /page\r\n\r\n", "400 Bad Request"},
      {"\r\n\r\n", "400 Bad Request"}};
  for (const auto& [request, status] : cases) {
    EXPECT_THAT(Reply(request), StartsWith(std::string("HTTP/1.1 ") + status)) << request;
  }
  EXPECT_THAT(Reply("POST /page HTTP/1.1\r\n\r\n"), HasSubstr("\r\nAllow: GET, HEAD\r\n"));
}

TEST(HttpReplyTest, RejectsAHeadThatIsTooLong) {
  EXPECT_FALSE(HttpReply(std::string(kMaxHttpHeadBytes, 'x'), Pages()).has_value());
  EXPECT_THAT(Reply(std::string(kMaxHttpHeadBytes + 1, 'x')), StartsWith("HTTP/1.1 431"));
}

}  // namespace
}  // namespace duet::server::metrics

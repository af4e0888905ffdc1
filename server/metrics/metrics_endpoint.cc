#include "server/metrics/metrics_endpoint.h"

#include <httplib.h>

#include <thread>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"

namespace duet::server::metrics {
namespace {

// Scrapes are rare and short; more threads would only hold slow clients.
constexpr std::size_t kThreads = 2;
constexpr int kTimeoutSeconds = 2;

// The library would set SO_REUSEPORT, with which a second server takes half of the first one's
// connections instead of failing to start.
void SetSocketOptions(socket_t socket) {
  const int yes = 1;
  setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
}

class HttplibEndpoint final : public MetricsEndpoint {
 public:
  explicit HttplibEndpoint(MetricsEndpointOptions options) : options_(std::move(options)) {
    server_.set_socket_options(SetSocketOptions);
    server_.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
    server_.set_read_timeout(kTimeoutSeconds);
    server_.set_write_timeout(kTimeoutSeconds);
    // One request a connection, so that stopping never waits for an idle scraper.
    server_.set_keep_alive_max_count(1);
    server_.set_payload_max_length(0);
    server_.Get("/metrics", [this](const httplib::Request&, httplib::Response& response) {
      response.set_content(options_.render(), "text/plain; version=0.0.4; charset=utf-8");
    });
    server_.Get("/healthz", [](const httplib::Request&, httplib::Response& response) {
      response.set_content("ok\n", "text/plain");
    });
    server_.Get("/readyz", [this](const httplib::Request&, httplib::Response& response) {
      const bool ready = options_.ready();
      response.status = ready ? 200 : 503;
      const std::string detail = options_.describe ? options_.describe() : "";
      response.set_content((ready ? "ready\n" : "not ready\n") + detail, "text/plain");
    });
  }

  ~HttplibEndpoint() override {
    server_.stop();
    if (thread_.joinable()) thread_.join();
  }

  absl::Status Start() {
    port_ = options_.port == 0 ? server_.bind_to_any_port(options_.host)
            : server_.bind_to_port(options_.host, options_.port) ? options_.port
                                                                 : -1;
    if (port_ < 0) {
      return absl::UnavailableError(absl::StrCat("cannot listen on ", options_.host, ":",
                                                 options_.port, " for metrics; is it in use?"));
    }
    thread_ = std::thread([this] { server_.listen_after_bind(); });
    // stop() is lost on a server that does not run yet.
    while (!server_.is_running()) std::this_thread::yield();
    return absl::OkStatus();
  }

  int port() const override { return port_; }

 private:
  const MetricsEndpointOptions options_;
  httplib::Server server_;
  std::thread thread_;
  int port_ = 0;
};

}  // namespace

absl::StatusOr<std::unique_ptr<MetricsEndpoint>> MetricsEndpoint::Start(
    MetricsEndpointOptions options) {
  auto endpoint = std::make_unique<HttplibEndpoint>(std::move(options));
  const absl::Status started = endpoint->Start();
  if (!started.ok()) return started;
  return endpoint;
}

}  // namespace duet::server::metrics

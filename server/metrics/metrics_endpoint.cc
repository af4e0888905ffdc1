#include "server/metrics/metrics_endpoint.h"

#include <event2/buffer.h>
#include <event2/listener.h>
#include <netinet/in.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <string>
#include <string_view>
#include <utility>

#include "server/common/listen_address.h"

namespace duet::server::metrics {
namespace {

// The largest head of a request, in bytes.
constexpr ev_ssize_t kMaxHeadBytes = 8192;
// Pause of the listener after accept has failed because no descriptors are left. The kernel keeps
// the connection waiting, and an immediate retry would keep a core busy.
constexpr timeval kRest = {0, 100'000};

int PortOf(evutil_socket_t listener) {
  sockaddr_storage address = {};
  socklen_t size = sizeof(address);
  getsockname(listener, reinterpret_cast<sockaddr*>(&address), &size);
  return ntohs(address.ss_family == AF_INET6
                   ? reinterpret_cast<const sockaddr_in6&>(address).sin6_port
                   : reinterpret_cast<const sockaddr_in&>(address).sin_port);
}

void Rest(evconnlistener* listener, void*) {
  evconnlistener_disable(listener);
  const auto resume = [](evutil_socket_t, short, void* resting) {
    evconnlistener_enable(static_cast<evconnlistener*>(resting));
  };
  event_base_once(evconnlistener_get_base(listener), -1, EV_TIMEOUT, resume, listener, &kRest);
}

// The connection ends with the reply.
void Reply(evhttp_request* request, bool is_good, const char* type, const std::string& body) {
  evkeyvalq* fields = evhttp_request_get_output_headers(request);
  evhttp_add_header(fields, "Content-Type", type);
  evhttp_add_header(fields, "Content-Length", std::to_string(body.size()).c_str());
  evhttp_add_header(fields, "Connection", "close");
  if (evhttp_request_get_command(request) != EVHTTP_REQ_HEAD) {
    evbuffer_add(evhttp_request_get_output_buffer(request), body.data(), body.size());
  }
  evhttp_send_reply(request, is_good ? HTTP_OK : HTTP_SERVUNAVAIL, nullptr, nullptr);
}

}  // namespace

MetricsEndpoint::MetricsEndpoint(MetricsEndpointOptions options)
    : options_(std::move(options)),
      stop_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
      loop_(event_base_new(), event_base_free),
      http_(evhttp_new(loop_.get()), evhttp_free),
      stopped_(event_new(
                   loop_.get(), stop_, EV_READ,
                   [](evutil_socket_t, short, void* loop) {
                     event_base_loopbreak(static_cast<event_base*>(loop));
                   },
                   loop_.get()),
               event_free) {
  event_set_log_callback([](int, const char*) {});  // every line of the server's output is JSON
  const timeval idle = {static_cast<time_t>(options_.idle_seconds),
                        static_cast<suseconds_t>(options_.idle_seconds * 1e6) % 1'000'000};
  evhttp_set_timeout_tv(http_.get(), &idle);
  evhttp_set_max_headers_size(http_.get(), kMaxHeadBytes);
  evhttp_set_allowed_methods(http_.get(), EVHTTP_REQ_GET | EVHTTP_REQ_HEAD);
  evhttp_set_gencb(
      http_.get(),
      [](evhttp_request* request, void* self) {
        static_cast<const MetricsEndpoint*>(self)->Answer(request);
      },
      this);
  event_add(stopped_.get(), nullptr);
}

MetricsEndpoint::~MetricsEndpoint() {
  eventfd_write(stop_, 1);
  if (thread_.joinable()) thread_.join();
  event_del(stopped_.get());
  close(stop_);
}

absl::Status MetricsEndpoint::Listen() {
  evhttp_bound_socket* const bound = evhttp_bind_socket_with_handle(
      http_.get(), options_.host.c_str(), static_cast<ev_uint16_t>(options_.port));
  if (bound == nullptr) return common::ListenFailure(options_.host, options_.port);
  evconnlistener_set_error_cb(evhttp_bound_socket_get_listener(bound), Rest);
  port_ = PortOf(evhttp_bound_socket_get_fd(bound));
  thread_ = std::thread([this] { event_base_dispatch(loop_.get()); });
  return absl::OkStatus();
}

absl::StatusOr<std::unique_ptr<MetricsEndpoint>> MetricsEndpoint::Start(
    MetricsEndpointOptions options) {
  std::unique_ptr<MetricsEndpoint> endpoint(new MetricsEndpoint(std::move(options)));
  const absl::Status listening = endpoint->Listen();
  if (!listening.ok()) return listening;
  return endpoint;
}

void MetricsEndpoint::Answer(evhttp_request* request) const {
  const char* const path = evhttp_uri_get_path(evhttp_request_get_evhttp_uri(request));
  const std::string_view page = path == nullptr ? "" : path;
  if (page == "/metrics") {
    Reply(request, true, "text/plain; version=0.0.4; charset=utf-8", options_.render());
  } else if (page == "/healthz") {
    const bool healthy = options_.healthy();
    Reply(request, healthy, "text/plain", healthy ? "ok\n" : "not reachable\n");
  } else if (page == "/readyz") {
    const bool ready = options_.ready();
    Reply(request, ready, "text/plain", ready ? "ready\n" : "not ready\n");
  } else {
    evhttp_send_error(request, HTTP_NOTFOUND, nullptr);
  }
}

}  // namespace duet::server::metrics

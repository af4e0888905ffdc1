#ifndef DUET_SERVER_METRICS_HTTP_REPLY_H_
#define DUET_SERVER_METRICS_HTTP_REPLY_H_

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace duet::server::metrics {

// The content of one page of the endpoint.
struct HttpPage {
  int code = 200;  // 200 or 503
  std::string content_type = "text/plain";
  std::string body;
};

// Path -> function that makes the page.
using HttpPages = std::map<std::string, std::function<HttpPage()>, std::less<>>;

// The largest head of a request, in bytes.
inline constexpr std::size_t kMaxHttpHeadBytes = 8192;

// Returns the whole response (RFC 9112) to what a client has sent so far, or nullopt while the head
// of its request is incomplete. Serves GET and HEAD of known pages; anything else gets 400, 404,
// 405, 431 or 505. Request bodies are not read. The connection ends with the response.
std::optional<std::string> HttpReply(std::string_view received, const HttpPages& pages);

}  // namespace duet::server::metrics

#endif  // DUET_SERVER_METRICS_HTTP_REPLY_H_

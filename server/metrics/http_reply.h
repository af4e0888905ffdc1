#ifndef DUET_SERVER_METRICS_HTTP_REPLY_H_
#define DUET_SERVER_METRICS_HTTP_REPLY_H_

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace duet::server::metrics {

// What one page of the endpoint says.
struct HttpPage {
  int code = 200;  // 200 or 503
  std::string content_type = "text/plain";
  std::string body;
};

// Path -> what makes the page.
using HttpPages = std::map<std::string, std::function<HttpPage()>, std::less<>>;

// The largest head of a request, in bytes.
inline constexpr std::size_t kMaxHttpHeadBytes = 8192;

// The whole response (RFC 9112) to what a client has sent so far; nothing while the head of its
// request is not complete. GET and HEAD of known pages; whatever else gets 400, 404, 405, 431 or
// 505. A body is neither waited for nor read. The connection ends with the response.
std::optional<std::string> HttpReply(std::string_view received, const HttpPages& pages);

}  // namespace duet::server::metrics

#endif  // DUET_SERVER_METRICS_HTTP_REPLY_H_

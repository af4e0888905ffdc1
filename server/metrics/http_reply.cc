#include "server/metrics/http_reply.h"

#include <algorithm>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"

namespace duet::server::metrics {
namespace {

std::string_view Reason(int code) {
  switch (code) {
    case 200:
      return "OK";
    case 400:
      return "Bad Request";
    case 404:
      return "Not Found";
    case 405:
      return "Method Not Allowed";
    case 431:
      return "Request Header Fields Too Large";
    case 503:
      return "Service Unavailable";
    default:
      return "HTTP Version Not Supported";
  }
}

std::string Response(const HttpPage& page, bool with_body = true) {
  return absl::StrCat("HTTP/1.1 ", page.code, " ", std::string(Reason(page.code)),
                      "\r\nContent-Type: ", page.content_type,
                      "\r\nContent-Length: ", page.body.size(),
                      page.code == 405 ? "\r\nAllow: GET, HEAD" : "",
                      "\r\nConnection: close\r\n\r\n", with_body ? page.body : "");
}

std::string Refusal(int code) {
  return Response({code, "text/plain", absl::StrCat(std::string(Reason(code)), "\n")});
}

bool IsToken(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(),
                                      [](unsigned char c) { return absl::ascii_isupper(c); });
}

// The three words of a request line. Split returns nullopt for any other number of words.
struct RequestLine {
  std::string_view method, target, version;
};
std::optional<RequestLine> Split(std::string_view line) {
  const std::size_t first = line.find(' ');
  const std::size_t last = line.rfind(' ');
  if (first == std::string_view::npos || first == last) return std::nullopt;
  return RequestLine{line.substr(0, first), line.substr(first + 1, last - first - 1),
                     line.substr(last + 1)};
}

}  // namespace

std::optional<std::string> HttpReply(std::string_view received, const HttpPages& pages) {
  const std::size_t end = received.find("\r\n\r\n");
  if (std::min(end, received.size()) > kMaxHttpHeadBytes) return Refusal(431);
  if (end == std::string_view::npos) return std::nullopt;
  const std::optional<RequestLine> line = Split(received.substr(0, received.find("\r\n")));
  if (!line || !IsToken(line->method)) return Refusal(400);
  const absl::string_view version(line->version.data(), line->version.size());
  if (version != "HTTP/1.1" && version != "HTTP/1.0") {
    return Refusal(absl::StartsWith(version, "HTTP/") ? 505 : 400);
  }
  const bool head = line->method == "HEAD";
  if (!head && line->method != "GET") return Refusal(405);
  const auto page = pages.find(line->target.substr(0, line->target.find('?')));
  if (page == pages.end()) return Refusal(404);
  return Response(page->second(), !head);
}

}  // namespace duet::server::metrics

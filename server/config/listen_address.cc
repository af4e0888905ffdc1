#include "server/config/listen_address.h"

#include <cstddef>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "absl/strings/strip.h"

namespace duet::server::config {
namespace {

bool IsAnyHost(const std::string& host) { return host == "0.0.0.0" || host == "::"; }

bool IsLoopback(const std::string& host) { return host == "127.0.0.1" || host == "::1"; }

}  // namespace

absl::StatusOr<ListenAddress> ParseListenAddress(const std::string& text) {
  const absl::Status malformed = absl::InvalidArgumentError(absl::StrCat(
      "expected host:port, such as 0.0.0.0:50051, with a port of 0 to 65535, got \"", text, "\""));
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos) return malformed;
  ListenAddress address;
  absl::string_view host(text.data(), colon);
  const bool bracketed = absl::ConsumePrefix(&host, "[") && absl::ConsumeSuffix(&host, "]");
  if (!bracketed && absl::StrContains(host, ":")) return malformed;
  address.host = host.empty() ? "0.0.0.0" : std::string(host);
  const absl::string_view port = absl::string_view(text).substr(colon + 1);
  if (!absl::SimpleAtoi(port, &address.port) || address.port < 0 || address.port > 65535) {
    return malformed;
  }
  return address;
}

std::string ToString(const ListenAddress& address) {
  const bool ipv6 = absl::StrContains(address.host, ":");
  return absl::StrCat(ipv6 ? "[" : "", address.host, ipv6 ? "]" : "", ":", address.port);
}

std::optional<ListenAddress> AddressOf(const std::string& setting) {
  absl::StatusOr<ListenAddress> address = ParseListenAddress(setting);
  if (!address.ok()) return std::nullopt;
  return *std::move(address);
}

bool Clash(const ListenAddress& a, const ListenAddress& b) {
  if (a.port != b.port || a.port == 0) return false;
  const bool local = (a.host == "localhost" && IsLoopback(b.host)) ||
                     (b.host == "localhost" && IsLoopback(a.host));
  return a.host == b.host || IsAnyHost(a.host) || IsAnyHost(b.host) || local;
}

}  // namespace duet::server::config

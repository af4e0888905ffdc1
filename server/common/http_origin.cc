#include "server/common/http_origin.h"

#include <algorithm>
#include <cstddef>

#include "absl/strings/ascii.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/strip.h"
#include "model/base/text.h"

namespace duet::server::common {
namespace {

// A name, an IPv4 address, or an IPv6 address in brackets.
bool IsHost(absl::string_view host) {
  const bool bracketed = absl::ConsumePrefix(&host, "[") && absl::ConsumeSuffix(&host, "]");
  return !host.empty() && std::all_of(host.begin(), host.end(), [bracketed](unsigned char c) {
    return absl::ascii_isalnum(c) || c == '-' || c == '.' || (bracketed ? c == ':' : c == '_');
  });
}

bool IsPort(absl::string_view text) {
  int number = 0;
  return std::all_of(text.begin(), text.end(), absl::ascii_isdigit) &&
         absl::SimpleAtoi(text, &number) && number >= 1 && number <= 65535;
}

}  // namespace

absl::StatusOr<HttpOrigin> ParseHttpOrigin(absl::string_view text) {
  HttpOrigin origin;
  absl::string_view authority = text;
  origin.encrypted = absl::ConsumePrefix(&authority, "https://");
  const bool known = origin.encrypted || absl::ConsumePrefix(&authority, "http://");
  const std::size_t colon = authority.rfind(':');
  if (!known || colon == absl::string_view::npos || !IsHost(authority.substr(0, colon)) ||
      !IsPort(authority.substr(colon + 1))) {
    return absl::InvalidArgumentError(
        absl::StrCat("expected http://HOST:PORT or https://HOST:PORT, got ", base::Quoted(text)));
  }
  origin.authority = std::string(authority);
  return origin;
}

}  // namespace duet::server::common

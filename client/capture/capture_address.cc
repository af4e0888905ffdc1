#include "client/capture/capture_address.h"

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/capture/rokoko_reader.h"
#include "client/capture/vmc_reader.h"
#include "client/capture/xsens_reader.h"
#include "model/base/text.h"

namespace duet::client::capture {
namespace {

struct Scheme {
  CaptureProtocol protocol;
  const char* prefix;
  int port;
};
constexpr Scheme kSchemes[] = {{CaptureProtocol::kVmc, "vmc://", 39539},
                               {CaptureProtocol::kXsens, "xsens://", 9763},
                               {CaptureProtocol::kRokoko, "rokoko://", 14043}};
constexpr int kMaxPort = 65535;

const Scheme* SchemeOf(absl::string_view text) {
  for (const Scheme& scheme : kSchemes) {
    if (absl::StartsWith(text, scheme.prefix)) return &scheme;
  }
  return nullptr;
}

absl::Status Bad(absl::string_view text, absl::string_view expected) {
  return absl::InvalidArgumentError(
      absl::StrCat("address: expected ", expected, ", got ", base::Quoted(text)));
}

}  // namespace

bool IsCaptureAddress(absl::string_view text) { return SchemeOf(text) != nullptr; }

absl::StatusOr<CaptureAddress> ParseCaptureAddress(absl::string_view text) {
  const Scheme* const scheme = SchemeOf(text);
  if (scheme == nullptr) return Bad(text, "vmc://, xsens:// or rokoko://[HOST][:PORT]");
  CaptureAddress address{scheme->protocol, "", scheme->port};
  absl::string_view rest = text.substr(absl::string_view(scheme->prefix).size());
  if (absl::StartsWith(rest, "[")) {
    const std::size_t end = rest.find(']');
    if (end == absl::string_view::npos) return Bad(text, "a bracket after an IPv6 address");
    address.host = std::string(rest.substr(1, end - 1));
    rest.remove_prefix(end + 1);
  } else {
    const std::size_t colon = rest.find(':');
    address.host = std::string(rest.substr(0, colon));
    rest.remove_prefix(address.host.size());
  }
  if (absl::StrContains(rest.substr(rest.empty() ? 0 : 1), ":")) {
    return Bad(text, "an IPv6 address in brackets, as in vmc://[::1]:39539");
  }
  if (rest.empty()) return address;
  if (rest[0] != ':' || !base::ParseInteger(rest.substr(1), &address.port) || address.port < 0 ||
      address.port > kMaxPort) {
    return Bad(text, absl::StrCat("a port from 0 to ", kMaxPort));
  }
  return address;
}

std::string FormatCaptureAddress(const CaptureAddress& address) {
  for (const Scheme& scheme : kSchemes) {
    if (scheme.protocol != address.protocol) continue;
    const bool brackets = absl::StrContains(address.host, ":");
    return absl::StrCat(scheme.prefix, brackets ? "[" : "", address.host, brackets ? "]" : "", ":",
                        address.port);
  }
  return "";
}

std::unique_ptr<StreamReader> MakeStreamReader(CaptureProtocol protocol) {
  switch (protocol) {
    case CaptureProtocol::kXsens:
      return std::make_unique<XsensReader>();
    case CaptureProtocol::kRokoko:
      return std::make_unique<RokokoReader>();
    case CaptureProtocol::kVmc:
      break;
  }
  return std::make_unique<VmcReader>();
}

}  // namespace duet::client::capture

#ifndef DUET_CLIENT_CAPTURE_CAPTURE_ADDRESS_H_
#define DUET_CLIENT_CAPTURE_CAPTURE_ADDRESS_H_

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "client/capture/stream_reader.h"

namespace duet::client::capture {

enum class CaptureProtocol { kVmc, kXsens, kRokoko };

// Where a capture protocol is received or sent.
struct CaptureAddress {
  CaptureProtocol protocol = CaptureProtocol::kVmc;
  std::string host;  // an IPv4 or IPv6 address or a name; empty: not stated
  int port = 0;      // the protocol's usual port, unless stated
};

// Whether the text begins with the scheme of a capture protocol: vmc://, xsens:// or rokoko://.
bool IsCaptureAddress(absl::string_view text);

// Parses "vmc://[HOST][:PORT]", "xsens://..." or "rokoko://...". The host of an IPv6 address is in
// brackets. Errors: INVALID_ARGUMENT naming the part that is wrong.
absl::StatusOr<CaptureAddress> ParseCaptureAddress(absl::string_view text);

// "vmc://127.0.0.1:39539".
std::string FormatCaptureAddress(const CaptureAddress& address);

std::unique_ptr<StreamReader> MakeStreamReader(CaptureProtocol protocol);

}  // namespace duet::client::capture

#endif  // DUET_CLIENT_CAPTURE_CAPTURE_ADDRESS_H_

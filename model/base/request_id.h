#ifndef DUET_MODEL_BASE_REQUEST_ID_H_
#define DUET_MODEL_BASE_REQUEST_ID_H_

#include "absl/status/status.h"
#include "absl/strings/string_view.h"

namespace duet::base {

// What a request ID is: the name of a call in the server's log, which the metadata x-request-id
// carries. Clients refuse anything else; the server replaces it by an ID of its own.
inline constexpr char kRequestIdForm[] = "1 to 128 printable ASCII characters without spaces";

bool IsRequestId(absl::string_view text);

// INVALID_ARGUMENT "expected <kRequestIdForm>, got ..." unless `text` is a request ID.
absl::Status CheckRequestId(absl::string_view text);

}  // namespace duet::base

#endif  // DUET_MODEL_BASE_REQUEST_ID_H_

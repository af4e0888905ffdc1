#ifndef DUET_CLIENT_CAPTURE_LZ4_FRAME_H_
#define DUET_CLIENT_CAPTURE_LZ4_FRAME_H_

#include <cstddef>
#include <string>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace duet::client::capture {

// Whether the bytes begin like an LZ4 frame.
bool IsLz4Frame(absl::string_view bytes);

// Decompresses one LZ4 frame of at most `max_bytes`. Checksums are not verified: UDP has its own.
//
// Errors: INVALID_ARGUMENT for a malformed frame, one that needs a dictionary, and one that would
//         be larger.
//
// Source: LZ4 frame format 1.6.2 and block format.
absl::StatusOr<std::string> DecompressLz4Frame(absl::string_view bytes, std::size_t max_bytes);

}  // namespace duet::client::capture

#endif  // DUET_CLIENT_CAPTURE_LZ4_FRAME_H_

#ifndef DUET_MODEL_BASE_SHA256_H_
#define DUET_MODEL_BASE_SHA256_H_

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"

namespace duet::base {

// The SHA-256 digest of `bytes` in lower-case hex (64 characters).
std::string Sha256Hex(std::string_view bytes);

// The same for a file's content, which is read in blocks of constant size. Fails with
// PERMISSION_DENIED if the file does not exist or cannot be opened, and with DATA_LOSS if it cannot
// be read to its end. Both messages name the path. `stop`: called before each block; if it returns
// true, fails with CANCELLED.
absl::StatusOr<std::string> Sha256HexOfFile(const std::filesystem::path& path,
                                            const std::function<bool()>& stop = nullptr);

}  // namespace duet::base

#endif  // DUET_MODEL_BASE_SHA256_H_

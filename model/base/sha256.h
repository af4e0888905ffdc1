#ifndef DUET_MODEL_BASE_SHA256_H_
#define DUET_MODEL_BASE_SHA256_H_

#include <filesystem>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"

namespace duet::base {

// The SHA-256 digest of `bytes` in lower-case hex (64 characters).
std::string Sha256Hex(std::string_view bytes);

// The same of a file's content, read in blocks: the memory it takes does not depend on the size.
// Fails with PERMISSION_DENIED when the file cannot be opened (an absent one too), DATA_LOSS when
// it cannot be read to its end; both name the path.
absl::StatusOr<std::string> Sha256HexOfFile(const std::filesystem::path& path);

}  // namespace duet::base

#endif  // DUET_MODEL_BASE_SHA256_H_

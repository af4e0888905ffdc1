#ifndef DUET_MODEL_BASE_SHA256_H_
#define DUET_MODEL_BASE_SHA256_H_

#include <string>
#include <string_view>

namespace duet::base {

// The SHA-256 digest of `bytes` in lower-case hex (64 characters).
std::string Sha256Hex(std::string_view bytes);

}  // namespace duet::base

#endif  // DUET_MODEL_BASE_SHA256_H_

#include "model/base/sha256.h"

#include <openssl/evp.h>

#include <cstddef>
#include <cstdlib>
#include <fstream>
#include <ios>
#include <memory>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"

namespace duet::base {
namespace {

constexpr std::size_t kReadBlock = std::size_t{1} << 18;

// A call fails only if libcrypto is broken. To continue would let a wrong file pass as verified.
void Require(int result) {
  if (result != 1) std::abort();
}

}  // namespace

std::string Sha256Hex(std::string_view bytes) {
  unsigned char digest[EVP_MAX_MD_SIZE];
  unsigned int size = 0;
  Require(EVP_Digest(bytes.data(), bytes.size(), digest, &size, EVP_sha256(), nullptr));
  return absl::BytesToHexString({reinterpret_cast<const char*>(digest), size});
}

absl::StatusOr<std::string> Sha256HexOfFile(const std::filesystem::path& path,
                                            const std::function<bool()>& stop) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return absl::PermissionDeniedError(absl::StrCat(path.string(), ": cannot be opened"));
  const std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context(EVP_MD_CTX_new(),
                                                                        EVP_MD_CTX_free);
  Require(EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr));
  std::vector<char> block(kReadBlock);
  while (file.read(block.data(), static_cast<std::streamsize>(block.size())) || file.gcount() > 0) {
    if (stop && stop()) return absl::CancelledError(absl::StrCat(path.string(), ": stopped"));
    const auto count = static_cast<std::size_t>(file.gcount());
    Require(EVP_DigestUpdate(context.get(), block.data(), count));
  }
  if (file.bad()) return absl::DataLossError(absl::StrCat(path.string(), ": cannot be read"));
  unsigned char digest[EVP_MAX_MD_SIZE];
  unsigned int size = 0;
  Require(EVP_DigestFinal_ex(context.get(), digest, &size));
  return absl::BytesToHexString({reinterpret_cast<const char*>(digest), size});
}

}  // namespace duet::base

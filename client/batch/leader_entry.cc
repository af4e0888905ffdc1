#include "client/batch/leader_entry.h"

#include "absl/strings/ascii.h"
#include "client/batch/file_name.h"

namespace duet::client::batch {

std::string KeyOf(const std::filesystem::path& path) {
  std::string key;
  for (const std::filesystem::path& part : path.relative_path().lexically_normal()) {
    std::string name = AsUtf8(part.string());
    if (name.empty() || name == "." || name == "..") continue;
    for (char& c : name) {
      const auto byte = static_cast<unsigned char>(c);
      // Bytes from 0x80 on are letters of other scripts in UTF-8.
      if (!absl::ascii_isalnum(byte) && byte < 0x80 && c != '_' && c != '-' && c != '+') c = '_';
    }
    if (!key.empty()) key += '/';
    key += name;
  }
  return key;
}

}  // namespace duet::client::batch

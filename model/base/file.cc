#include "model/base/file.h"

#include <cerrno>
#include <fstream>
#include <ios>
#include <system_error>

#include "absl/strings/str_cat.h"

namespace duet::base {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kReadBlock = std::size_t{1} << 16;
constexpr std::size_t kMebibyte = std::size_t{1} << 20;

std::string SizeText(std::size_t bytes) {
  if (bytes % kMebibyte != 0) return absl::StrCat(bytes, " bytes");
  return absl::StrCat(bytes / kMebibyte, " MiB");
}

absl::Status CheckReadable(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) {
    return absl::NotFoundError(absl::StrCat(path.string(), ": no such file"));
  }
  if (status.type() == fs::file_type::directory) {
    return absl::InvalidArgumentError(absl::StrCat(path.string(), ": is a folder, wanted a file"));
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<std::string> ReadFile(const fs::path& path, std::size_t max_bytes,
                                     absl::string_view wanted) {
  if (absl::Status status = CheckReadable(path); !status.ok()) return status;
  std::ifstream file(path, std::ios::binary);
  if (!file) return absl::PermissionDeniedError(absl::StrCat(path.string(), ": cannot be opened"));
  std::string content;
  std::string block(kReadBlock, '\0');
  while (file.read(block.data(), static_cast<std::streamsize>(block.size())) || file.gcount() > 0) {
    content.append(block, 0, static_cast<std::size_t>(file.gcount()));
    if (content.size() > max_bytes) {
      return absl::InvalidArgumentError(
          absl::StrCat(path.string(), ": larger than ", SizeText(max_bytes), ", wanted ", wanted));
    }
  }
  if (file.bad()) return absl::DataLossError(absl::StrCat(path.string(), ": cannot be read"));
  return content;
}

absl::Status WriteFile(const fs::path& path, absl::string_view content) {
  std::error_code error;
  if (fs::is_directory(path, error)) {
    return absl::InvalidArgumentError(absl::StrCat(path.string(), ": is a folder, wanted a file"));
  }
  // A pipe or a device cannot be replaced, only written to.
  const bool special = fs::exists(path, error) && !fs::is_regular_file(path, error);
  const fs::path target = special ? path : fs::path(path.string() + ".partial");
  errno = 0;
  std::ofstream file(target, std::ios::binary | std::ios::trunc);
  file.write(content.data(), static_cast<std::streamsize>(content.size()));
  file.close();
  if (!file) {
    const std::error_code why(errno, std::generic_category());
    if (!special) fs::remove(target, error);
    return absl::PermissionDeniedError(
        absl::StrCat(path.string(), ": cannot be written", why ? ": " + why.message() : ""));
  }
  if (!special) fs::rename(target, path, error);
  if (error) {
    return absl::PermissionDeniedError(
        absl::StrCat(path.string(), ": cannot be written: ", error.message()));
  }
  return absl::OkStatus();
}

}  // namespace duet::base

#include "model/base/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <ios>
#include <system_error>

#include "absl/strings/str_cat.h"
#include "model/base/descriptor.h"
#include "model/base/missing_file.h"
#include "model/base/write_error.h"

namespace duet::base {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kReadBlock = std::size_t{1} << 16;
constexpr std::size_t kMebibyte = std::size_t{1} << 20;

std::string SizeText(std::size_t bytes) {
  if (bytes % kMebibyte != 0) return absl::StrCat(bytes, " bytes");
  return absl::StrCat(bytes / kMebibyte, " MiB");
}

// Sets `bytes` to the size. INVALID_ARGUMENT unless the descriptor is open on a regular file.
absl::Status CheckRegular(int descriptor, const fs::path& path, std::size_t* bytes) {
  struct stat info;
  if (fstat(descriptor, &info) != 0) return absl::ErrnoToStatus(errno, path.string());
  *bytes = static_cast<std::size_t>(info.st_size);
  if (S_ISREG(info.st_mode)) return absl::OkStatus();
  const char* kind = S_ISDIR(info.st_mode)    ? "a folder"
                     : S_ISFIFO(info.st_mode) ? "a named pipe"
                                              : "a device or socket";
  return absl::InvalidArgumentError(
      absl::StrCat(path.string(), ": expected a file, got ", kind,
                   S_ISDIR(info.st_mode) ? "" : "; copy it to a file first"));
}

}  // namespace

absl::StatusOr<std::string> ReadFile(const fs::path& path, std::size_t max_bytes,
                                     absl::string_view expected) {
  // O_NONBLOCK: otherwise, opening a named pipe waits for its writer.
  const Descriptor file(open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  if (!file.ok() && (errno == ENOENT || errno == ENOTDIR || errno == ELOOP)) {
    return MissingFile(path);
  }
  if (!file.ok()) {
    return absl::PermissionDeniedError(absl::StrCat(path.string(), ": cannot be opened"));
  }
  std::size_t bytes = 0;
  if (absl::Status status = CheckRegular(file.get(), path, &bytes); !status.ok()) return status;
  const auto too_large = [&] {
    return absl::InvalidArgumentError(absl::StrCat(
        path.string(), ": expected ", expected, " of at most ", SizeText(max_bytes), ", got more"));
  };
  if (bytes > max_bytes) return too_large();
  // One byte more than the size, so that a file that keeps its size is read without growing.
  std::string content(bytes + 1, '\0');
  std::size_t filled = 0;
  while (true) {
    if (filled == content.size()) content.resize(filled + kReadBlock);
    const ssize_t got = read(file.get(), &content[filled], content.size() - filled);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return absl::DataLossError(absl::StrCat(path.string(), ": cannot be read"));
    filled += static_cast<std::size_t>(got);
    if (filled > max_bytes) return too_large();
    if (got > 0) continue;
    content.resize(filled);
    return content;
  }
}

absl::Status WriteFile(const fs::path& path, absl::string_view content) {
  std::error_code error;
  if (fs::is_directory(path, error)) {
    return absl::InvalidArgumentError(
        absl::StrCat(path.string(), ": expected a file, got a folder"));
  }
  // A pipe or a device can be written to, but not replaced.
  const bool special = fs::exists(path, error) && !fs::is_regular_file(path, error);
  const fs::path target = special ? path : fs::path(path.string() + ".partial");
  errno = 0;
  std::ofstream file(target, std::ios::binary | std::ios::trunc);
  file.write(content.data(), static_cast<std::streamsize>(content.size()));
  file.close();
  if (!file) {
    const int why = errno;
    if (!special) fs::remove(target, error);
    return CannotBeWritten(path, why);
  }
  if (!special) fs::rename(target, path, error);
  return error ? CannotBeWritten(path, error.value()) : absl::OkStatus();
}

}  // namespace duet::base

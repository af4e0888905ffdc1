#include "model/base/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <ios>
#include <string>
#include <system_error>

#include "absl/strings/str_cat.h"
#include "model/base/descriptor.h"
#include "model/base/text.h"

namespace duet::base {
namespace {

namespace fs = std::filesystem;

// Empty if the path is no symbolic link.
std::string DescribeLink(const fs::path& path) {
  std::error_code error;
  const fs::path target = fs::read_symlink(path, error);
  if (error) return "";
  const bool exists = fs::exists(path, error);
  return !exists && error == std::errc::too_many_symbolic_link_levels
             ? "; it is a symbolic link that leads back to itself"
             : absl::StrCat("; it is a symbolic link to ", EscapeControls(target.string()));
}

}  // namespace

absl::Status MissingFile(const fs::path& path, absl::string_view kind) {
  return absl::NotFoundError(absl::StrCat(path.string(), ": no such ", kind, DescribeLink(path)));
}

bool IsLasting(int error) {
  switch (error) {
    case EISDIR:
    case ELOOP:
    case ENAMETOOLONG:
    case ENOTDIR:
    case EROFS:
      return true;
    default:
      return false;
  }
}

absl::Status CannotBeWritten(const fs::path& path, int error) {
  const std::string why = error == 0 ? "" : ": " + std::generic_category().message(error);
  const std::string message = absl::StrCat(path.string(), ": cannot be written", why);
  return IsLasting(error) ? absl::FailedPreconditionError(message)
                          : absl::PermissionDeniedError(message);
}

namespace {

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

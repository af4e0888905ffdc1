#include "model/base/file_io.h"

#include <fcntl.h>
#include <stdio.h>  // renameat2
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "absl/strings/str_cat.h"
#include "model/base/descriptor.h"

namespace duet::base {
namespace {

namespace fs = std::filesystem;

constexpr mode_t kFolderMode = 0755;
constexpr mode_t kFileMode = 0644;

absl::Status Error(int code, const fs::path& path) {
  return absl::ErrnoToStatus(code, path.string());
}

// Replaces the codes that open() sets for a symbolic link (ELOOP, ENOTDIR), which explain little.
absl::Status OpenError(int code, const fs::path& path, const char* expected) {
  if (code != ELOOP && code != ENOTDIR) return Error(code, path);
  return absl::InvalidArgumentError(absl::StrCat(path.string(), ": expected ", expected,
                                                 ", got another kind of file or a symbolic link"));
}

// Removes a final separator, with which open() would follow a symbolic link.
fs::path Plain(const fs::path& path) {
  const fs::path normal = path.lexically_normal();
  return normal.has_filename() ? normal : normal.parent_path();
}

absl::Status CreateFile(const fs::path& path, const std::string& content) {
  const Descriptor file(open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kFileMode));
  if (!file.ok()) return Error(errno, path);
  for (std::size_t at = 0; at < content.size();) {
    const ssize_t written = write(file.get(), content.data() + at, content.size() - at);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return Error(errno, path);
    at += static_cast<std::size_t>(written);
  }
  return fsync(file.get()) == 0 ? absl::OkStatus() : Error(errno, path);
}

// Writes the entries of a folder to the disk.
absl::Status SyncFolder(const fs::path& path) {
  const Descriptor folder(open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!folder.ok() || fsync(folder.get()) != 0) return Error(errno, path);
  return absl::OkStatus();
}

absl::Status Fill(const fs::path& folder, const std::vector<NamedContent>& files) {
  if (chmod(folder.c_str(), kFolderMode) != 0) return Error(errno, folder);
  for (const auto& [name, content] : files) {
    if (absl::Status status = CreateFile(folder / name, content); !status.ok()) return status;
  }
  return SyncFolder(folder);
}

absl::Status Publish(const fs::path& from, const fs::path& to) {
  int failed = renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE);
  // Some network file systems support only rename(), which replaces at most an empty folder.
  if (failed != 0 && errno == EINVAL) failed = rename(from.c_str(), to.c_str());
  if (failed == 0) return SyncFolder(to.parent_path());
  if (errno == EEXIST || errno == ENOTEMPTY) {
    return absl::AlreadyExistsError(absl::StrCat(to.string(), ": exists"));
  }
  return Error(errno, to);
}

}  // namespace

Folder::Folder(int descriptor, fs::path path) : descriptor_(descriptor), path_(std::move(path)) {}

Folder::Folder(Folder&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)), path_(std::move(other.path_)) {}

Folder::~Folder() {
  if (descriptor_ >= 0) close(descriptor_);
}

absl::StatusOr<Folder> Folder::Open(const fs::path& path) {
  const fs::path plain = Plain(path);
  const int descriptor = open(plain.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (descriptor < 0) return OpenError(errno, plain, "a folder");
  return Folder(descriptor, plain);
}

absl::StatusOr<std::string> Folder::Read(const std::string& name, std::size_t max_bytes) const {
  const fs::path path = path_ / name;
  // O_NONBLOCK: otherwise, opening a named pipe waits for its writer.
  const Descriptor file(
      openat(descriptor_, name.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  if (!file.ok()) return OpenError(errno, path, "a regular file");
  struct stat info;
  if (fstat(file.get(), &info) != 0) return Error(errno, path);
  if (!S_ISREG(info.st_mode)) {
    return absl::InvalidArgumentError(
        absl::StrCat(path.string(), ": expected a regular file, got another kind"));
  }
  if (static_cast<uint64_t>(info.st_size) > max_bytes) {
    return absl::InvalidArgumentError(absl::StrCat(path.string(), ": expected at most ", max_bytes,
                                                   " bytes, got ", info.st_size));
  }
  std::string content(static_cast<std::size_t>(info.st_size), '\0');
  std::size_t at = 0;
  while (at < content.size()) {
    const ssize_t got = read(file.get(), content.data() + at, content.size() - at);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return Error(errno, path);
    if (got == 0) return absl::DataLossError(absl::StrCat(path.string(), ": shrank while read"));
    at += static_cast<std::size_t>(got);
  }
  return content;
}

absl::Status WriteFolder(const fs::path& path, const std::vector<NamedContent>& files) {
  const fs::path plain = fs::absolute(Plain(path));
  std::error_code error;
  if (fs::symlink_status(plain, error).type() != fs::file_type::not_found) {
    return absl::AlreadyExistsError(absl::StrCat(plain.string(), ": exists"));
  }
  fs::create_directories(plain.parent_path(), error);
  if (error) return Error(error.value(), plain.parent_path());

  std::string temporary = (plain.parent_path() / ("." + plain.filename().string() + ".XXXXXX"));
  if (mkdtemp(temporary.data()) == nullptr) return Error(errno, temporary);
  absl::Status status = Fill(temporary, files);
  if (status.ok()) status = Publish(temporary, plain);
  if (!status.ok()) fs::remove_all(temporary, error);
  return status;
}

}  // namespace duet::base

#include "client/batch/durable_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <system_error>

#include "absl/strings/str_cat.h"
#include "model/base/file.h"

namespace duet::client::batch {
namespace {

namespace fs = std::filesystem;

constexpr mode_t kFileMode = 0644;

}  // namespace

absl::Status CannotWrite(const fs::path& path, int error) {
  const std::string message =
      absl::StrCat("cannot write ", path.string(), ": ", std::generic_category().message(error));
  return base::IsLasting(error) ? absl::FailedPreconditionError(message)
                                : absl::AbortedError(message);
}

absl::Status WriteAll(int descriptor, absl::string_view content, const fs::path& path) {
  while (!content.empty()) {
    const ssize_t written = write(descriptor, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return CannotWrite(path, errno);
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  return absl::OkStatus();
}

absl::Status RenameInto(const std::string& from, const std::string& to) {
  if (rename(from.c_str(), to.c_str()) == 0) return absl::OkStatus();
  if (errno != ENOENT) return CannotWrite(to, errno);
  std::error_code error;
  fs::create_directories(fs::path(to).parent_path(), error);
  if (error) return CannotWrite(fs::path(to).parent_path(), error.value());
  return rename(from.c_str(), to.c_str()) == 0 ? absl::OkStatus() : CannotWrite(to, errno);
}

absl::Status SyncFileSystem(const fs::path& folder) {
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return CannotWrite(folder, errno);
  const absl::Status status =
      syncfs(descriptor) == 0 ? absl::OkStatus() : CannotWrite(folder, errno);
  close(descriptor);
  return status;
}

FileGroup::~FileGroup() {
  for (const Pending& file : pending_) unlink(file.temporary.c_str());
}

std::string FileGroup::Begin(const std::string& path) {
  pending_.push_back({absl::StrCat(temporary_.string(), "/", count_++), out_ + path});
  return pending_.back().temporary;
}

absl::Status FileGroup::Add(const std::string& path, absl::string_view content) {
  const std::string temporary = Begin(path);
  const int file = open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kFileMode);
  if (file < 0) return CannotWrite(temporary, errno);
  absl::Status status = WriteAll(file, content, temporary);
  if (close(file) != 0 && status.ok()) status = CannotWrite(temporary, errno);
  return status;
}

absl::Status FileGroup::Commit() {
  if (pending_.empty()) return absl::OkStatus();
  absl::Status status = SyncFileSystem(temporary_);
  if (!status.ok()) return status;
  for (const Pending& file : pending_) {
    status = RenameInto(file.temporary, file.path);
    if (!status.ok()) return status;
  }
  pending_.clear();
  return SyncFileSystem(temporary_);  // the new names
}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) close(descriptor_);
}

absl::Status FolderLock::Take(const fs::path& file) {
  descriptor_ = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, kFileMode);
  if (descriptor_ < 0) return CannotWrite(file, errno);
  if (flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return absl::OkStatus();
  if (errno != EWOULDBLOCK) return CannotWrite(file, errno);
  return absl::AbortedError(
      absl::StrCat(file.parent_path().parent_path().string(), ": is in use by another duet batch"));
}

}  // namespace duet::client::batch

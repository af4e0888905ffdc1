#include "client/batch/durable_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <system_error>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "model/base/write_error.h"

namespace duet::client::batch {
namespace {

namespace fs = std::filesystem;

constexpr mode_t kFileMode = 0644;
constexpr std::size_t kBufferBytes = std::size_t{1} << 20;

absl::Status WriteAll(int descriptor, absl::string_view content, const fs::path& path) {
  while (!content.empty()) {
    const ssize_t written = write(descriptor, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return CannotWrite(path, errno);
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  return absl::OkStatus();
}

// Flushes the names of new folders, including parents, to disk.
absl::Status MakeFolders(const fs::path& folder) {
  std::vector<fs::path> missing;
  std::error_code error;
  for (fs::path at = folder; !at.empty() && !fs::exists(at, error); at = at.parent_path()) {
    missing.push_back(at);
  }
  for (auto at = missing.rbegin(); at != missing.rend(); ++at) {
    fs::create_directory(*at, error);
    if (error) return CannotWrite(*at, error.value());
    absl::Status status = SyncFolder(at->has_parent_path() ? at->parent_path() : ".");
    if (!status.ok()) return status;
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status CannotWrite(const fs::path& path, int error) {
  const std::string message =
      absl::StrCat("cannot write ", path.string(), ": ", std::generic_category().message(error));
  return base::IsLasting(error) ? absl::FailedPreconditionError(message)
                                : absl::AbortedError(message);
}

absl::Status RenameInto(const std::string& from, const std::string& to) {
  if (rename(from.c_str(), to.c_str()) == 0) return absl::OkStatus();
  if (errno != ENOENT) return CannotWrite(to, errno);
  absl::Status status = MakeFolders(fs::path(to).parent_path());
  if (!status.ok()) return status;
  return rename(from.c_str(), to.c_str()) == 0 ? absl::OkStatus() : CannotWrite(to, errno);
}

absl::Status WriteFileUnsynced(const std::string& path, absl::string_view content) {
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kFileMode);
  if (file < 0) return CannotWrite(path, errno);
  absl::Status status = WriteAll(file, content, path);
  if (close(file) != 0 && status.ok()) status = CannotWrite(path, errno);
  return status;
}

absl::Status SyncFileSystem(const fs::path& folder) {
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return CannotWrite(folder, errno);
  const absl::Status status =
      syncfs(descriptor) == 0 ? absl::OkStatus() : CannotWrite(folder, errno);
  close(descriptor);
  return status;
}

absl::Status WriteDurably(const fs::path& temporary, const fs::path& path,
                          absl::string_view content) {
  const int file = open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kFileMode);
  if (file < 0) return CannotWrite(temporary, errno);
  absl::Status status = WriteAll(file, content, path);
  if (status.ok() && fsync(file) != 0) status = CannotWrite(path, errno);
  close(file);
  if (status.ok()) status = RenameInto(temporary, path);
  if (!status.ok()) unlink(temporary.c_str());
  return status;
}

absl::Status SyncFolder(const fs::path& folder) {
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return CannotWrite(folder, errno);
  const absl::Status status =
      fsync(descriptor) == 0 ? absl::OkStatus() : CannotWrite(folder, errno);
  close(descriptor);
  return status;
}

absl::Status ReplaceDurably(const fs::path& path, absl::string_view content) {
  absl::Status status = WriteDurably(path.string() + ".partial", path, content);
  return status.ok() ? SyncFolder(path.parent_path()) : status;
}

DurableFile::~DurableFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

absl::Status DurableFile::Open() {
  descriptor_ = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kFileMode);
  return descriptor_ < 0 ? CannotWrite(temporary_, errno) : absl::OkStatus();
}

absl::Status DurableFile::Flush() {
  absl::Status status = WriteAll(descriptor_, buffer_, temporary_);
  buffer_.clear();
  return status;
}

absl::Status DurableFile::Append(absl::string_view content) {
  buffer_.append(content.data(), content.size());
  return buffer_.size() < kBufferBytes ? absl::OkStatus() : Flush();
}

absl::Status DurableFile::Finish(const fs::path& path) {
  absl::Status status = Flush();
  if (status.ok() && fsync(descriptor_) != 0) status = CannotWrite(temporary_, errno);
  if (status.ok()) status = RenameInto(temporary_, path);
  return status.ok() ? SyncFolder(path.parent_path()) : status;
}

AppendedFile::~AppendedFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

absl::Status AppendedFile::Open() {
  if (descriptor_ >= 0 || !broken_.ok()) return broken_;
  descriptor_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, kFileMode);
  const off_t end = descriptor_ < 0 ? -1 : lseek(descriptor_, 0, SEEK_END);
  if (end < 0) return broken_ = CannotWrite(path_, errno);
  size_ = synced_size_ = static_cast<uint64_t>(end);
  return broken_ = SyncFolder(path_.parent_path());
}

absl::Status AppendedFile::Flush() {
  if (broken_.ok()) broken_ = WriteAll(descriptor_, buffer_, path_);
  buffer_.clear();
  return broken_;
}

absl::Status AppendedFile::Append(absl::string_view content) {
  buffer_.append(content.data(), content.size());
  size_ += content.size();
  return buffer_.size() < kBufferBytes ? broken_ : Flush();
}

absl::Status AppendedFile::Commit() {
  if (size_ == synced_size_) return broken_;
  absl::Status status = Flush();
  if (status.ok() && fdatasync(descriptor_) != 0) broken_ = CannotWrite(path_, errno);
  synced_size_ = size_;
  return broken_;
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

#include "client/batch/durable_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <set>
#include <system_error>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "model/base/file.h"

namespace duet::client::batch {
namespace {

namespace fs = std::filesystem;

constexpr mode_t kFileMode = 0644;
constexpr std::size_t kBufferBytes = std::size_t{1} << 20;

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

absl::Status WriteUnsynced(const std::string& path, absl::string_view content) {
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kFileMode);
  if (file < 0) return CannotWrite(path, errno);
  absl::Status status = WriteAll(file, content, path);
  if (close(file) != 0 && status.ok()) status = CannotWrite(path, errno);
  return status;
}

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
  absl::Status status = MakeFolders(fs::path(to).parent_path());
  if (!status.ok()) return status;
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

absl::Status SyncFolder(const fs::path& folder) {
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return CannotWrite(folder, errno);
  const absl::Status status =
      fsync(descriptor) == 0 ? absl::OkStatus() : CannotWrite(folder, errno);
  close(descriptor);
  return status;
}

absl::Status WriteDurably(const fs::path& temporary, const fs::path& path,
                          absl::string_view content) {
  DurableFile file(temporary);
  absl::Status status = file.Open();
  if (status.ok()) status = file.Append(content);
  return status.ok() ? file.Finish(path) : status;
}

FileGroup::~FileGroup() {
  for (const Pending& file : pending_) unlink(file.temporary.c_str());
}

absl::Status FileGroup::Add(const std::string& path, absl::string_view content) {
  pending_.push_back({absl::StrCat(temporary_.string(), "/", count_++), out_ + path});
  return WriteUnsynced(pending_.back().temporary, content);
}

absl::Status FileGroup::Commit() {
  if (pending_.empty()) return absl::OkStatus();
  absl::Status status = SyncFileSystem(temporary_);
  if (!status.ok()) return status;
  std::set<std::string> folders;
  for (const Pending& file : pending_) {
    status = RenameInto(file.temporary, file.path);
    if (!status.ok()) return status;
    folders.insert(file.path.substr(0, file.path.rfind('/')));
  }
  pending_.clear();
  for (const std::string& folder : folders) status.Update(SyncFolder(folder));
  return status;
}

DurableFile::~DurableFile() {
  if (descriptor_ < 0) return;
  close(descriptor_);
  if (!finished_) unlink(temporary_.c_str());
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
  if (!status.ok()) return status;
  finished_ = true;
  return SyncFolder(path.parent_path());
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

#ifndef DUET_CLIENT_BATCH_DURABLE_FILE_H_
#define DUET_CLIENT_BATCH_DURABLE_FILE_H_

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"

namespace duet::client::batch {

// Files that are complete or absent, even if the process or the machine stops at any time.
//
// Errors: ABORTED with the path and the system's message: the same run may succeed later, for
// example when the disk has space again.

// Renames a file, and creates folders as needed. SyncFileSystem makes it durable.
absl::Status RenameInto(const std::string& from, const std::string& to);
// Flushes everything on the file system of a folder to disk.
absl::Status SyncFileSystem(const std::filesystem::path& folder);

// Many files that reach the disk together, because a flush costs as much as several of them: each
// is written under a temporary name, all are flushed, then renamed in their order. Files that were
// not committed when the process ends are discarded.
class FileGroup {
 public:
  // Paths of files are relative to `out`, which is on the file system of `temporary`.
  FileGroup(std::filesystem::path temporary, const std::filesystem::path& out)
      : temporary_(std::move(temporary)), out_(out.string() + "/") {}
  FileGroup(const FileGroup&) = delete;
  FileGroup& operator=(const FileGroup&) = delete;
  ~FileGroup();

  absl::Status Add(const std::string& path, absl::string_view content);
  // Adds a file whose content the caller writes, before Commit, under the returned temporary name.
  std::string Begin(const std::string& path);
  // When it returns, the added files are on disk under their names.
  absl::Status Commit();

 private:
  struct Pending {
    std::string temporary, path;
  };
  const std::filesystem::path temporary_;
  const std::string out_;
  std::vector<Pending> pending_;
  int64_t count_ = 0;
};

// Writes all of `content` to an open file; errors name `path`.
absl::Status WriteAll(int descriptor, absl::string_view content, const std::filesystem::path& path);

// "cannot write <path>: <what errno means>". FAILED_PRECONDITION if no retry changes it: a file
// where a folder must be or the reverse, links that lead back to themselves, a disk that
// is read-only; otherwise ABORTED.
absl::Status CannotWrite(const std::filesystem::path& path, int error);

// A lock for one process that works in a folder; released when the process ends. ABORTED while
// another process holds it.
class FolderLock {
 public:
  FolderLock() = default;
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  ~FolderLock();
  absl::Status Take(const std::filesystem::path& file);

 private:
  int descriptor_ = -1;
};

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_DURABLE_FILE_H_

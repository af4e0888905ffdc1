#ifndef DUET_CLIENT_BATCH_DURABLE_FILE_H_
#define DUET_CLIENT_BATCH_DURABLE_FILE_H_

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"

namespace duet::client::batch {

// Files that are complete or absent, even if the process or the machine stops at any time.
//
// Errors: ABORTED with the path and the system's message: the same run may succeed later, for
// example
//         when the disk has space again.

// Writes `temporary`, flushes it to disk and renames it to its place; creates folders as needed.
// Both paths are on the same file system. SyncFolder makes the name durable.
absl::Status WriteDurably(const std::filesystem::path& temporary, const std::filesystem::path& path,
                          absl::string_view content);
// The steps of it, for many files at once. A file that is written and not yet brought to the disk;
absl::Status WriteFileUnsynced(const std::string& path, absl::string_view content);
// everything on the file system that `folder` is on brought there;
absl::Status SyncFileSystem(const std::filesystem::path& folder);
// its place, whose folders are made as needed.
absl::Status RenameInto(const std::string& from, const std::string& to);
// Brings a folder's names to the disk.
absl::Status SyncFolder(const std::filesystem::path& folder);
// Both, for a file that nobody else waits for.
absl::Status ReplaceDurably(const std::filesystem::path& path, absl::string_view content);

// A file that is written piece by piece and then given its place. A file that is not finished
// leaves `temporary` behind.
class DurableFile {
 public:
  explicit DurableFile(std::filesystem::path temporary) : temporary_(std::move(temporary)) {}
  DurableFile(const DurableFile&) = delete;
  DurableFile& operator=(const DurableFile&) = delete;
  ~DurableFile();

  // Replaces the temporary file. Once, before all else.
  absl::Status Open();
  absl::Status Append(absl::string_view content);
  // On the disk at `path` when it returns.
  absl::Status Finish(const std::filesystem::path& path);

 private:
  absl::Status Flush();

  std::filesystem::path temporary_;
  std::string buffer_;
  int descriptor_ = -1;
};

// A file to append to; its content is kept.
class AppendedFile {
 public:
  explicit AppendedFile(std::filesystem::path path) : path_(std::move(path)) {}
  AppendedFile(const AppendedFile&) = delete;
  AppendedFile& operator=(const AppendedFile&) = delete;
  ~AppendedFile();

  // Before all else; once it is open, nothing.
  absl::Status Open();
  absl::Status Append(absl::string_view content);
  // On the disk when it returns.
  absl::Status Commit();
  // With all that was appended.
  uint64_t size() const { return size_; }

 private:
  absl::Status Flush();

  std::filesystem::path path_;
  std::string buffer_;
  int descriptor_ = -1;
  uint64_t size_ = 0;
  uint64_t synced_size_ = 0;
  absl::Status broken_;
};

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

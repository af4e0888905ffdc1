#ifndef DUET_MODEL_BASE_FILE_IO_H_
#define DUET_MODEL_BASE_FILE_IO_H_

#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace duet::base {

// Folders as a whole; single files are file.h's.

// A file's name and content.
using NamedContent = std::pair<std::string, std::string>;

// A folder held open, so that all its files come from one place even if it is renamed meanwhile.
class Folder {
 public:
  // NOT_FOUND when absent; INVALID_ARGUMENT when it is a symbolic link or no folder.
  static absl::StatusOr<Folder> Open(const std::filesystem::path& path);
  Folder(Folder&& other) noexcept;
  Folder& operator=(Folder&& other) = delete;
  ~Folder();

  // A regular file of at most `max_bytes`. Symbolic links and anything but a regular file are
  // refused without waiting for a writer.
  absl::StatusOr<std::string> Read(const std::string& name, std::size_t max_bytes) const;

 private:
  Folder(int descriptor, std::filesystem::path path);

  int descriptor_;
  std::filesystem::path path_;
};

// Creates a folder with these files, on the disk when it returns, whole or not at all: a reader
// sees no folder or all of it. ALREADY_EXISTS when there is something at `path`.
absl::Status WriteFolder(const std::filesystem::path& path, const std::vector<NamedContent>& files);

}  // namespace duet::base

#endif  // DUET_MODEL_BASE_FILE_IO_H_

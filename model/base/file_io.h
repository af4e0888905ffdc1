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

// Reads and writes whole folders. For single files, see file.h.

// A file's name and content.
using NamedContent = std::pair<std::string, std::string>;

// A folder that is held open: all files come from the same folder, even if it is renamed meanwhile.
class Folder {
 public:
  // NOT_FOUND if there is no such folder; INVALID_ARGUMENT if it is a symbolic link or not a
  // folder.
  static absl::StatusOr<Folder> Open(const std::filesystem::path& path);
  Folder(Folder&& other) noexcept;
  Folder& operator=(Folder&& other) = delete;
  ~Folder();

  // Reads a regular file of at most `max_bytes`. Rejects symbolic links and anything that is not a
  // regular file, without waiting for a pipe's writer.
  absl::StatusOr<std::string> Read(const std::string& name, std::size_t max_bytes) const;

 private:
  Folder(int descriptor, std::filesystem::path path);

  int descriptor_;
  std::filesystem::path path_;
};

// Creates a folder with these files atomically: a reader sees either no folder or all of it. All
// files are on the disk when this returns. ALREADY_EXISTS if something exists at `path`.
absl::Status WriteFolder(const std::filesystem::path& path, const std::vector<NamedContent>& files);

}  // namespace duet::base

#endif  // DUET_MODEL_BASE_FILE_IO_H_

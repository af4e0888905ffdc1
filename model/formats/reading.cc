#include "model/formats/reading.h"

#include <system_error>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "model/base/file.h"
#include "model/motion/motion_limits.h"

namespace duet::formats {
namespace {

namespace fs = std::filesystem;

// The folder of the file that a path leads to; empty if there is no such file.
fs::path FolderOf(const fs::path& path) {
  std::error_code error;
  const fs::path target = fs::canonical(path, error);
  return error ? fs::path() : target.parent_path();
}

}  // namespace

absl::StatusOr<std::string> ReadFileBeside(const fs::path& document, const std::string& name,
                                           const char* what) {
  const fs::path path = document.parent_path() / name;
  std::error_code error;
  const fs::path target = fs::canonical(path, error);
  if (error) return base::ReadFile(path, motion::kMaxMotionFileBytes, what);
  const fs::path here = document.parent_path().empty() ? "." : document.parent_path();
  const fs::path folder = fs::canonical(here, error);
  if (target.parent_path() != folder && target.parent_path() != FolderOf(document)) {
    return absl::InvalidArgumentError(absl::StrCat(path.string(), ": expected ", what,
                                                   " in the folder of ", document.string(),
                                                   ", got a link to a file in another folder"));
  }
  return base::ReadFile(target, motion::kMaxMotionFileBytes, what);
}

}  // namespace duet::formats

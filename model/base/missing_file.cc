#include "model/base/missing_file.h"

#include <string>
#include <system_error>

#include "absl/strings/str_cat.h"
#include "model/base/printable.h"

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

}  // namespace duet::base

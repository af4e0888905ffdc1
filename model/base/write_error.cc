#include "model/base/write_error.h"

#include <cerrno>
#include <string>
#include <system_error>

#include "absl/strings/str_cat.h"

namespace duet::base {

bool IsLasting(int error) {
  switch (error) {
    case EISDIR:
    case ELOOP:
    case ENAMETOOLONG:
    case ENOTDIR:
    case EROFS:
      return true;
    default:
      return false;
  }
}

absl::Status CannotBeWritten(const std::filesystem::path& path, int error) {
  const std::string why = error == 0 ? "" : ": " + std::generic_category().message(error);
  const std::string message = absl::StrCat(path.string(), ": cannot be written", why);
  return IsLasting(error) ? absl::FailedPreconditionError(message)
                          : absl::PermissionDeniedError(message);
}

}  // namespace duet::base

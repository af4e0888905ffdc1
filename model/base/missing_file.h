#ifndef DUET_MODEL_BASE_MISSING_FILE_H_
#define DUET_MODEL_BASE_MISSING_FILE_H_

#include <filesystem>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"

namespace duet::base {

// NOT_FOUND "<path>: no such <kind>" for a path that cannot be opened because nothing is there. If
// the path is a symbolic link, the message says where it leads.
absl::Status MissingFile(const std::filesystem::path& path, absl::string_view kind = "file");

}  // namespace duet::base

#endif  // DUET_MODEL_BASE_MISSING_FILE_H_

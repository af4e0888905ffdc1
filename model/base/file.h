#ifndef DUET_MODEL_BASE_FILE_H_
#define DUET_MODEL_BASE_FILE_H_

#include <cstddef>
#include <filesystem>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace duet::base {

// Returns the content of a file. `expected` names the kind of file, with its article, for the
// message about a file that is too large: "key.pem: expected a PEM file of at most 1 MiB, got
// more".
//
// Errors: NOT_FOUND, PERMISSION_DENIED or INVALID_ARGUMENT (too large, or not a regular file); the
//         message names the path. A named pipe is rejected without waiting for its writer.
absl::StatusOr<std::string> ReadFile(const std::filesystem::path& path, std::size_t max_bytes,
                                     absl::string_view expected);

// Replaces a file atomically: a failed write leaves no partial file. A pipe or a device is written
// to directly. Errors: INVALID_ARGUMENT (a folder), and those of CannotBeWritten,
// naming the path.
absl::Status WriteFile(const std::filesystem::path& path, absl::string_view content);

// NOT_FOUND "<path>: no such <kind>" for a path that cannot be opened because nothing is there. If
// the path is a symbolic link, the message says where it leads.
absl::Status MissingFile(const std::filesystem::path& path, absl::string_view kind = "file");

// Whether writing fails with this errno again until somebody changes the path or its mount. A full
// disk and a folder that is closed may be different the next time.
bool IsLasting(int error);

// "<path>: cannot be written: <what errno means>". FAILED_PRECONDITION if the error lasts,
// otherwise PERMISSION_DENIED.
absl::Status CannotBeWritten(const std::filesystem::path& path, int error);

}  // namespace duet::base

#endif  // DUET_MODEL_BASE_FILE_H_

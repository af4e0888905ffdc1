#ifndef DUET_MODEL_BASE_WRITE_ERROR_H_
#define DUET_MODEL_BASE_WRITE_ERROR_H_

#include <filesystem>

#include "absl/status/status.h"

namespace duet::base {

// Whether writing fails with this errno again until somebody changes the path or its mount. A full
// disk and a folder that is closed may be different the next time.
bool IsLasting(int error);

// "<path>: cannot be written: <what errno means>". FAILED_PRECONDITION if the error lasts,
// otherwise PERMISSION_DENIED.
absl::Status CannotBeWritten(const std::filesystem::path& path, int error);

}  // namespace duet::base

#endif  // DUET_MODEL_BASE_WRITE_ERROR_H_

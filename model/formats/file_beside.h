#ifndef DUET_MODEL_FORMATS_FILE_BESIDE_H_
#define DUET_MODEL_FORMATS_FILE_BESIDE_H_

#include <filesystem>
#include <string>

#include "absl/status/statusor.h"

namespace duet::formats {

// Reads the file `name` in the folder of `document`, which names it. `what` names the kind of file,
// with its article. Symbolic links are followed only to files in the same folder, or in the folder
// to which `document` itself is a link.
//
// Errors: those of base::ReadFile; INVALID_ARGUMENT for a link to another folder.
absl::StatusOr<std::string> ReadFileBeside(const std::filesystem::path& document,
                                           const std::string& name, const char* what);

}  // namespace duet::formats

#endif  // DUET_MODEL_FORMATS_FILE_BESIDE_H_

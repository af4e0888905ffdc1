#ifndef DUET_MODEL_FORMATS_PEOPLE_H_
#define DUET_MODEL_FORMATS_PEOPLE_H_

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "model/formats/motion_file.h"
#include "model/motion/clip.h"

// What the programs and the Python package have in common when they read and write whole files.

namespace duet::formats {

// All people of a file, at most two.
struct ReadPeople {
  std::vector<motion::Clip> people;
  std::vector<std::string> notes;  // on how the first was read
};

// Reads one person, like ReadLeader, from a source that the function knows.
using PersonReader = absl::FunctionRef<absl::StatusOr<motion::Clip>(const ReadOptions&)>;
absl::StatusOr<ReadPeople> ReadAllPeople(PersonReader read, const ReadOptions& options);

// Checks, before any work is done, that a file exists and has a format that is read: `format`, or
// that of its extension. Errors: NOT_FOUND, INVALID_ARGUMENT.
absl::Status CheckReadable(const std::filesystem::path& path, const std::optional<Format>& format);

// INVALID_ARGUMENT unless the folder that a file is to be written to exists.
absl::Status CheckFolderOf(const std::filesystem::path& path);

}  // namespace duet::formats

#endif  // DUET_MODEL_FORMATS_PEOPLE_H_

#ifndef DUET_CLIENT_CLI_MOTION_INPUT_H_
#define DUET_CLIENT_CLI_MOTION_INPUT_H_

#include <filesystem>
#include <istream>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/cli/motion_arguments.h"
#include "model/formats/motion_file.h"
#include "model/formats/people.h"
#include "model/motion/clip.h"
#include "model/motion/skeleton.h"

namespace duet::client::cli {

// A motion file, or standard input, which is read completely and only once.
class MotionInput {
 public:
  // `-` is standard input; `in` may be null if there is none.
  static absl::StatusOr<MotionInput> Open(const std::filesystem::path& path, std::istream* in);

  // Its name in errors and reports.
  const std::string& name() const { return name_; }

  // Like formats::ReadLeader. Warns in the notes and the report of a person of no likely size.
  absl::StatusOr<motion::Clip> Read(const formats::ReadOptions& options) const;

 private:
  std::string name_;
  std::optional<std::string> content_;  // of standard input
};

absl::StatusOr<formats::ReadPeople> ReadAllPeople(const MotionInput& input,
                                                  const formats::ReadOptions& options);

// `joints` and those of a table file, which `joints` override. `table_file` may be empty.
absl::StatusOr<retargeting::JointOverrides> ReadJoints(retargeting::JointOverrides joints,
                                                       const std::filesystem::path& table_file);

// Reads the table of joints that the flags name, if any.
absl::StatusOr<formats::ReadOptions> ToReadOptions(const InputArguments& input,
                                                   const motion::Skeleton& skeleton);

// Checks that the file exists and has a known format. `-` needs `format`.
absl::Status CheckInput(const std::filesystem::path& path,
                        const std::optional<formats::Format>& format);
absl::Status CheckExists(const std::filesystem::path& path);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_MOTION_INPUT_H_

#ifndef DUET_CLIENT_CLI_MOTION_INPUT_H_
#define DUET_CLIENT_CLI_MOTION_INPUT_H_

#include <filesystem>
#include <istream>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/cli/arguments.h"
#include "model/formats/motion_file.h"
#include "model/motion/clip.h"
#include "model/motion/skeleton.h"

namespace duet::client::cli {

// A motion file, or standard input, of which the whole is read once.
class MotionInput {
 public:
  // `-` is standard input; `in` may be null, where there is none.
  static absl::StatusOr<MotionInput> Open(const std::filesystem::path& path, std::istream* in);

  // How errors and reports call it.
  const std::string& name() const { return name_; }

  // As formats::ReadLeader.
  absl::StatusOr<motion::Clip> Read(const formats::ReadOptions& options) const;

 private:
  std::string name_;
  std::optional<std::string> content_;  // of standard input
};

// All that one file holds, at most two people.
struct ReadPeople {
  std::vector<motion::Clip> people;
  std::vector<std::string> notes;  // on how the first was read
};
absl::StatusOr<ReadPeople> ReadAllPeople(const MotionInput& input,
                                         const formats::ReadOptions& options);

// `joints` and those of a table; `joints` win over it. Without a table's file, as they are.
absl::StatusOr<retargeting::JointOverrides> ReadJoints(retargeting::JointOverrides joints,
                                                       const std::filesystem::path& table_file);

// Reads the table of joints that the flags name, if any.
absl::StatusOr<formats::ReadOptions> ToReadOptions(const InputArguments& input,
                                                   const motion::Skeleton& skeleton);

// Whether the file is there and of a known kind; `-` always is.
absl::Status CheckInput(const std::filesystem::path& path,
                        const std::optional<formats::Format>& format);
absl::Status CheckExists(const std::filesystem::path& path);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_MOTION_INPUT_H_

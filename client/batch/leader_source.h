#ifndef DUET_CLIENT_BATCH_LEADER_SOURCE_H_
#define DUET_CLIENT_BATCH_LEADER_SOURCE_H_

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/batch/leader_entry.h"
#include "model/formats/motion_file.h"

namespace duet::client::batch {

// A sequence of leaders. Its memory does not depend on the length of the list.
class LeaderSource {
 public:
  virtual ~LeaderSource() = default;
  // The next leader; nullopt at the end. After INVALID_ARGUMENT, which concerns one line, the next
  // call continues with the next line, so that all bad lines can be reported together. Any other
  // error ends the list.
  virtual absl::StatusOr<std::optional<LeaderEntry>> Next() = 0;
};

// Files, folders (all motion files below, also links to missing ones, by name; .txt and .json
// files that hold something else are skipped and added to `passed_over`, which may be null) and
// patterns ("walks/*.bvh"; * and ? within one part of a path). Files of a folder are named by their
// path in it, other files by their own name. With `format`, a file may have any extension, and
// files of a folder or a pattern any extension that is not that of another format.
//
// Errors: NOT_FOUND for missing inputs; INVALID_ARGUMENT for a file of unknown format, for two
//         leaders with the same key, and if there is no motion file.
absl::StatusOr<std::unique_ptr<LeaderSource>> ListLeaders(
    const std::vector<std::string>& inputs,
    const std::optional<formats::Format>& format = std::nullopt,
    std::vector<std::string>* passed_over = nullptr);

// Checks inputs before anything else is done: NOT_FOUND for missing ones, and INVALID_ARGUMENT if
// the data set `out` is in a folder of leaders, where the next run would take its files for
// leaders. Accepts patterns unchecked.
absl::Status CheckInputs(const std::vector<std::string>& inputs, const std::filesystem::path& out);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_LEADER_SOURCE_H_

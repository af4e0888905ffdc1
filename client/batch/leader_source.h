#ifndef DUET_CLIENT_BATCH_LEADER_SOURCE_H_
#define DUET_CLIENT_BATCH_LEADER_SOURCE_H_

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/batch/leader_entry.h"
#include "model/formats/motion_file.h"

namespace duet::client::batch {

// Leaders one after the other, so that a list of any length takes no memory.
class LeaderSource {
 public:
  virtual ~LeaderSource() = default;
  // The next one; nothing at the end. INVALID_ARGUMENT is of one line: the call after it goes on
  // with the next line, so that all bad lines can be reported together. Any other error ends the
  // list.
  virtual absl::StatusOr<std::optional<LeaderEntry>> Next() = 0;
};

// Files, folders (all motion files below, by name; .txt and .json files that hold something else
// are passed over and named in `passed_over`, which may be null) and patterns ("walks/*.bvh"; * and
// ? within one part of a path). A folder's files are named by their path in it, a file by its own
// name. Where `format` is said, a file may have any name, those of a folder or a pattern any that
// tells no other format.
//
// Errors: NOT_FOUND for what is not there, INVALID_ARGUMENT for a file of no known kind, for two
//         leaders of one key, and where there is no motion file at all.
absl::StatusOr<std::unique_ptr<LeaderSource>> ListLeaders(
    const std::vector<std::string>& inputs,
    const std::optional<formats::Format>& format = std::nullopt,
    std::vector<std::string>* passed_over = nullptr);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_LEADER_SOURCE_H_

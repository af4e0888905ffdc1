#ifndef DUET_CLIENT_BATCH_LEADER_INDEXES_H_
#define DUET_CLIENT_BATCH_LEADER_INDEXES_H_

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "model/dataset/leader_side.h"

namespace duet::client::batch {

// The index.tsv files of data sets of captures (docs/datasets.md) that list leaders. Each is read
// once.
class LeaderIndexes {
 public:
  // The entry of a file in the index.tsv of the nearest folder above it that has one, at most four
  // folders up; null if there is none. Files named index.tsv without the required columns are no
  // indexes. FAILED_PRECONDITION for an index with a line that is invalid.
  absl::StatusOr<const dataset::IndexEntry*> Find(const std::filesystem::path& file);

 private:
  using Entries = std::map<std::string, dataset::IndexEntry>;  // by path below the folder
  // Null if the folder has none.
  absl::StatusOr<const Entries*> In(const std::filesystem::path& folder);

  std::map<std::filesystem::path, std::unique_ptr<const Entries>> indexes_;  // by folder
};

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_LEADER_INDEXES_H_

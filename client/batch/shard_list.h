#ifndef DUET_CLIENT_BATCH_SHARD_LIST_H_
#define DUET_CLIENT_BATCH_SHARD_LIST_H_

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/batch/journal.h"
#include "client/batch/recipe.h"

namespace duet::client::batch {

// The items of each shard of a packed set. They are fixed before the first byte of a shard is
// written, so that an interrupted, lost or damaged shard is written again with the same bytes, and
// items that are done later go to new shards.
//
// The file is a journal (journal.h) of shards instead of items, {"items": [[first, last],
// ...], "bytes": ..., "sha256": ...}; the last two once the shard is written.

struct PackedShard {
  // Ranges of items, first to last, in increasing order; empty if the shard does not exist.
  std::vector<std::pair<int64_t, int64_t>> items;
  // Digest of the file; empty before it is written.
  uint64_t bytes = 0;
  std::string sha256;
  // Of all its items; empty if the set is not divided.
  std::string split;
};

// "set-000003.tar", "set-train-000003.tar"
std::string ShardName(Packing packing, size_t number, const std::string& split = "");

class ShardList {
 public:
  // Reads `file`; a missing list is empty. Errors: those of JournalReader::Open.
  static absl::StatusOr<ShardList> Open(const std::filesystem::path& file);

  // Adds an item that is in no shard to the new shard of its split, and begins another one if it
  // would exceed `shard_bytes`. Call in the order of the items.
  void Add(int64_t item, uint64_t bytes, uint64_t shard_bytes, const std::string& split = "");
  // Replaces a shard.
  void Set(size_t number, PackedShard shard);
  // Writes the changes of Add and Set to disk. ABORTED as in durable_file.h.
  absl::Status Commit();

  const std::vector<PackedShard>& shards() const { return shards_; }
  bool empty() const { return ranges_.empty(); }
  // Makes ShardOf include added items; Commit does this too.
  void Reindex();
  static constexpr size_t kNone = static_cast<size_t>(-1);
  // The number of the shard that an item is in.
  size_t ShardOf(int64_t item) const;
  std::string NameOf(size_t number, Packing packing) const {
    return ShardName(packing, number, shards_[number].split);
  }

 private:
  struct Range {
    int64_t first = 0, last = 0;
    size_t shard = 0;
  };

  std::filesystem::path file_;
  uint64_t size_ = 0;  // of the file's complete lines
  std::vector<PackedShard> shards_;
  std::vector<Range> ranges_;  // of all shards, in increasing order
  std::vector<size_t> changed_;
  struct Filling {
    size_t shard = kNone;
    uint64_t bytes = 0;
  };
  std::map<std::string, Filling> filling_;  // by split
};

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_SHARD_LIST_H_

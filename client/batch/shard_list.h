#ifndef DUET_CLIENT_BATCH_SHARD_LIST_H_
#define DUET_CLIENT_BATCH_SHARD_LIST_H_

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/batch/journal.h"
#include "client/batch/recipe.h"

namespace duet::client::batch {

// Which items a packed set's shards hold: settled before the first byte of a shard is written and
// kept, so that a shard that was stopped, lost or damaged is written again as it was, and items
// that are done later go to further shards.
//
// On the disk it is a journal (journal.h) of shards in place of items, {"items": [[first, last],
// ...], "bytes": ..., "sha256": ...}; the last two once the shard is written.

struct PackedShard {
  // Ranges of items from the first to the last, rising; none of a shard that does not exist.
  std::vector<std::pair<int64_t, int64_t>> items;
  // Of the whole file; empty before it is written.
  uint64_t bytes = 0;
  std::string sha256;
};

// "set-000003.tar"
std::string ShardName(Packing packing, size_t number);

class ShardList {
 public:
  // Reads `file`; a list that is not there is empty. Errors as of JournalReader::Open.
  static absl::StatusOr<ShardList> Open(const std::filesystem::path& file);

  // Puts an item that is in no shard yet into the first shard that has no items, and there after
  // the item before it, until the next would pass `shard_bytes`. Items come in their order.
  void Add(int64_t item, uint64_t bytes, uint64_t shard_bytes);
  // Replaces what is known of a shard.
  void Set(size_t number, PackedShard shard);
  // Brings what Add and Set changed to the disk. ABORTED as of durable_file.h.
  absl::Status Commit();

  const std::vector<PackedShard>& shards() const { return shards_; }
  bool empty() const { return ranges_.empty(); }
  // Has ShardOf know what was added; Commit does so too.
  void Reindex();
  static constexpr size_t kNone = static_cast<size_t>(-1);
  // The number of the shard that an item is in.
  size_t ShardOf(int64_t item) const;

 private:
  struct Range {
    int64_t first = 0, last = 0;
    size_t shard = 0;
  };

  std::filesystem::path file_;
  uint64_t size_ = 0;  // of the file's whole lines
  std::vector<PackedShard> shards_;
  std::vector<Range> ranges_;  // of all shards, rising
  std::vector<size_t> changed_;
  size_t filling_ = kNone;
  uint64_t filled_bytes_ = 0;
};

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_SHARD_LIST_H_

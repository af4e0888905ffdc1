#ifndef DUET_CLIENT_BATCH_PACKING_H_
#define DUET_CLIENT_BATCH_PACKING_H_

#include <cstdint>
#include <filesystem>
#include <string>

#include "absl/status/status.h"
#include "client/batch/job_folder.h"
#include "client/batch/journal.h"
#include "client/batch/recipe.h"

namespace duet::client::batch {

// Which shard each item falls to: items in their order, a new shard where the next would pass the
// size.
class ShardNames {
 public:
  ShardNames(Packing packing, uint64_t shard_bytes) : packing_(packing), room_(shard_bytes) {}
  // The shard of the next item: "set-000000.tar". Empty without packing.
  std::string Next(uint64_t item_bytes);

 private:
  Packing packing_;
  uint64_t room_;
  uint64_t used_ = 0;
  int number_ = 0;
};

// Whether a set has shards already, and so takes no more items.
bool IsPacked(Packing packing, uint64_t shard_bytes, const std::filesystem::path& out);

// Puts the files of every item that is done into shards in `folder`, each written under another
// name first, and removes them once their shard is on the disk. Goes on where it was stopped.
//
// Errors: ABORTED, DATA_LOSS where an item's file is not what the journal says.
absl::Status Pack(const JournalReader& journal, Packing packing, uint64_t shard_bytes,
                  const JobFolder& folder);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_PACKING_H_

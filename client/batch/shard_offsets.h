#ifndef DUET_CLIENT_BATCH_SHARD_OFFSETS_H_
#define DUET_CLIENT_BATCH_SHARD_OFFSETS_H_

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "client/batch/recipe.h"

namespace duet::client::batch {

// Where the files of items begin in their shards. Nothing is read: the layout of a shard follows
// from the records of its items (archive.h).
class ShardOffsets {
 public:
  explicit ShardOffsets(Packing packing) : packing_(packing) {}

  // The offset of the content of file number `file` of the next item of `shard`; call for all items
  // of a shard in their order. `record`: as stored in the shard, so without the name of its shard.
  uint64_t Next(size_t shard, const nlohmann::ordered_json& record, size_t file);

 private:
  Packing packing_;
  std::map<size_t, uint64_t> ends_;  // of the items so far, by shard
};

// The name of an item's file in a shard. `path`: of the record.
std::string MemberName(Packing packing, const std::string& path);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_SHARD_OFFSETS_H_

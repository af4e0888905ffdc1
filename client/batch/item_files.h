#ifndef DUET_CLIENT_BATCH_ITEM_FILES_H_
#define DUET_CLIENT_BATCH_ITEM_FILES_H_

#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/batch/job_folder.h"
#include "client/batch/shard_list.h"

namespace duet::client::batch {

// Where items' files lie while a data set is made: as files below a folder, or, where they will be
// packed, one after the other in a single file, the spool. A file for each of a million items costs
// more than all else that is done for it.

struct ItemFile {
  std::string path;  // below the data set's folder
  std::string content;
};

// Where an item's first file begins in the spool; nothing for one that is a file.
using SpoolPlace = std::optional<uint64_t>;

// Brings items' files to the disk, many at a time. What was added and not committed when the
// process ends was never there.
//
// Errors: ABORTED as of durable_file.h; after one it takes nothing more.
class ItemWriter {
 public:
  virtual ~ItemWriter() = default;
  virtual absl::StatusOr<SpoolPlace> Add(const std::vector<ItemFile>& files) = 0;
  // What was added is on the disk under its names when it returns.
  virtual absl::Status Commit() = 0;
};
// `folder` is open and outlives the writer.
std::unique_ptr<ItemWriter> MakeItemWriter(const JobFolder& folder, Packing packing);

// Reads the files back.
//
// Threads: safe to call concurrently.
class ItemReader {
 public:
  // `items`: the folder of those that are files; `spool` need not be there.
  ItemReader(std::filesystem::path items, const std::filesystem::path& spool);
  ItemReader(const ItemReader&) = delete;
  ItemReader& operator=(const ItemReader&) = delete;
  ~ItemReader();

  // Has Read look in the shards too, for what is nowhere else. `shards` outlives the reader.
  void LookInShards(std::filesystem::path out, Packing packing, const ShardList* shards);

  // The content of the record's file of this number. DATA_LOSS where it is not what the record
  // says.
  absl::StatusOr<std::string> Read(const nlohmann::ordered_json& record, const SpoolPlace& place,
                                   size_t file) const;

  // The item's files will not be read again.
  void Forget(const nlohmann::ordered_json& record, const SpoolPlace& place);
  // Gives their room back to the disk, where the file system can.
  void Release();
  // They will be read again after all.
  void Keep();

 private:
  absl::StatusOr<std::string> ReadSpool(uint64_t offset, uint64_t bytes) const;
  absl::StatusOr<std::string> ReadOutside(const nlohmann::ordered_json& record,
                                          const SpoolPlace& place, size_t file) const;
  absl::StatusOr<std::string> ReadShard(const nlohmann::ordered_json& record, size_t file) const;

  std::filesystem::path out_;  // where the shards lie
  Packing packing_ = Packing::kNone;
  const ShardList* shards_ = nullptr;
  std::filesystem::path items_, spool_;
  int descriptor_ = -1;  // of the spool
  std::vector<std::filesystem::path> forgotten_;
  std::vector<std::pair<uint64_t, uint64_t>> ranges_;  // of the spool: from, bytes
};

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_ITEM_FILES_H_

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

// The files of items while a data set is made: files below a folder, or, if they will be packed,
// parts of a single file, the spool. Creating a file for each of a million items would cost more
// than all other work for it.

struct ItemFile {
  std::string path;  // below the data set's folder
  std::string content;
};

// The offset of an item's first file in the spool; nullopt if it is a file of its own.
using SpoolPlace = std::optional<uint64_t>;

// Writes the files of many items to disk at a time. Files that were not committed when the process
// ends are discarded.
//
// Errors: ABORTED as in durable_file.h; after an error, it accepts no more files.
class ItemWriter {
 public:
  virtual ~ItemWriter() = default;
  virtual absl::StatusOr<SpoolPlace> Add(const std::vector<ItemFile>& files) = 0;
  // When it returns, the added files are on disk under their names.
  virtual absl::Status Commit() = 0;
};
// `folder` is open and outlives the writer.
std::unique_ptr<ItemWriter> MakeItemWriter(const JobFolder& folder, Packing packing);

// Reads the files back.
//
// Threads: safe to call concurrently.
class ItemReader {
 public:
  // `items`: the folder of the files; `spool` need not exist.
  ItemReader(std::filesystem::path items, const std::filesystem::path& spool);
  ItemReader(const ItemReader&) = delete;
  ItemReader& operator=(const ItemReader&) = delete;
  ~ItemReader();

  // Makes Read look in the shards too, for files that are nowhere else. `shards` outlives the
  // reader.
  void LookInShards(std::filesystem::path out, Packing packing, const ShardList* shards);

  // The content of a file of the record. DATA_LOSS if it does not match the record.
  absl::StatusOr<std::string> Read(const nlohmann::ordered_json& record, const SpoolPlace& place,
                                   size_t file) const;

  // Marks the item's files as not needed any more.
  void Forget(const nlohmann::ordered_json& record, const SpoolPlace& place);
  // Frees the disk space of these files, if the file system can.
  void Release();
  // Unmarks them.
  void Keep();

 private:
  absl::StatusOr<std::string> ReadSpool(uint64_t offset, uint64_t bytes) const;
  absl::StatusOr<std::string> ReadOutside(const nlohmann::ordered_json& record,
                                          const SpoolPlace& place, size_t file) const;
  absl::StatusOr<std::string> ReadShard(const nlohmann::ordered_json& record, size_t file) const;

  std::filesystem::path out_;  // the folder of the shards
  Packing packing_ = Packing::kNone;
  const ShardList* shards_ = nullptr;
  std::filesystem::path items_, spool_;
  int descriptor_ = -1;  // of the spool
  std::vector<std::filesystem::path> forgotten_;
  std::vector<std::pair<uint64_t, uint64_t>> ranges_;  // of the spool: from, bytes
};

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_ITEM_FILES_H_

#ifndef DUET_CLIENT_BATCH_ITEM_TABLE_H_
#define DUET_CLIENT_BATCH_ITEM_TABLE_H_

#include <cstdint>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "client/batch/job_folder.h"
#include "client/batch/set_file.h"
#include "client/batch/shard_list.h"
#include "client/batch/shard_offsets.h"

namespace duet::client::batch {

// items/<split>.csv: one row for each done item, in a file for each split, for programs that read
// tables and not Duet's index. Reference: docs/batch.md.
// Source: RFC 4180, with "\n" as the end of a line.

// A column, and the name of its type in Hugging Face's `features`.
struct TableColumn {
  std::string name;
  const char* type;
};
std::vector<TableColumn> TableColumns(const SetDescription& description);

// "items/train.csv"
std::string TablePath(const std::string& split);

// Writes the tables. Records come in the order of the items.
class ItemTables {
 public:
  // The arguments outlive the tables.
  ItemTables(const JobIdentity& identity, const ShardList& shards);

  absl::Status Open(SetFiles* files);
  // `record`: of a done item, as in the journal.
  absl::Status Add(int64_t item, const nlohmann::ordered_json& record);
  absl::Status Finish();

 private:
  // Where the file is that a row names.
  struct Place {
    std::string shard;
    std::string path;
    uint64_t offset = 0;
  };
  Place PlaceOf(int64_t item, const nlohmann::ordered_json& record, size_t file);
  std::string Row(const nlohmann::ordered_json& record, const std::string& split,
                  const Place& place, size_t file) const;

  const JobIdentity& identity_;
  const ShardList& shards_;
  const std::vector<std::string> classes_;
  std::map<std::string, bool> free_;  // by model
  ShardOffsets offsets_;
  std::map<std::string, std::unique_ptr<SetFile>> tables_;  // by split
};

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_ITEM_TABLE_H_

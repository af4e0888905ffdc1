#ifndef DUET_CLIENT_BATCH_SURVEY_H_
#define DUET_CLIENT_BATCH_SURVEY_H_

#include <cstdint>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/batch/damage.h"
#include "client/batch/item_files.h"
#include "client/batch/job_folder.h"
#include "client/batch/journal.h"
#include "client/batch/leader_digests.h"
#include "client/batch/made_by.h"
#include "client/batch/plan.h"
#include "client/batch/shard_list.h"

namespace duet::client::batch {

// The state of a plan after earlier runs.
struct Survey {
  JournalReader journal;
  ShardList shards;
  // By item number, only for surveyed items: whether the item is settled and its files exist with
  // their sizes. The files are not read.
  std::vector<bool> settled;
  bool all_packed = true;  // whether all done items are in a shard
  // Digests of all leaders that have an answer.
  std::unique_ptr<LeaderDigests> leaders;
  // How all answers were made.
  std::unique_ptr<Makers> makers;

  bool IsSettled(int64_t item) const {
    return item < static_cast<int64_t>(settled.size()) && settled[static_cast<size_t>(item)];
  }
};

// Compares the items of a plan with the journal and the files of earlier runs, before the first
// call.
class Surveyor {
 public:
  // Removes damaged lines of the journal. `folder` is open and was begun, or will be begun, with
  // `identity`; both outlive the surveyor. With `retry_failed`, items that failed permanently are
  // not settled. Errors: ABORTED, DATA_LOSS if the folder cannot be written or read.
  static absl::StatusOr<std::unique_ptr<Surveyor>> Open(const JobFolder& folder,
                                                        const JobIdentity& identity,
                                                        bool retry_failed);

  // Adds an item of this run's share of the plan. Returns whether it is settled. Call it for each
  // item of the share, in the order of the plan. Errors: FAILED_PRECONDITION, with the item or the
  // leader, if the set was begun with another plan or a leader's file has changed since; ABORTED,
  // DATA_LOSS as in Open.
  absl::StatusOr<bool> Add(const Item& item);

  const Survey& survey() const { return survey_; }

 private:
  Surveyor(const JobFolder& folder, const JobIdentity& identity, bool retry_failed, Survey survey);
  absl::Status CheckLeader(const LeaderEntry& leader, const nlohmann::ordered_json& record);
  absl::StatusOr<bool> IsSettled(int64_t item, const nlohmann::ordered_json& record,
                                 const SpoolPlace& place);
  bool HasFiles(const nlohmann::ordered_json& record) const;
  bool IsInSpool(const nlohmann::ordered_json& record, const SpoolPlace& place) const;
  bool CanReadSpool(const nlohmann::ordered_json& record, const SpoolPlace& place) const;
  absl::StatusOr<const std::set<int64_t>*> BadItemsOf(size_t number);

  const JobFolder& folder_;
  const JobIdentity& identity_;
  const bool retry_failed_;
  Survey survey_;
  const Damage damage_;
  const ItemReader files_;
  uint64_t spool_bytes_ = 0;
  std::map<size_t, std::set<int64_t>> bad_;  // by shard
};

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_SURVEY_H_

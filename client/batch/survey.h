#ifndef DUET_CLIENT_BATCH_SURVEY_H_
#define DUET_CLIENT_BATCH_SURVEY_H_

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "absl/container/flat_hash_map.h"
#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/batch/answer.h"
#include "client/batch/job_folder.h"
#include "client/batch/journal.h"
#include "client/batch/leaders.h"
#include "client/batch/plan.h"

namespace duet::client::batch {

// Which settled items a run requests again, besides those whose files are missing or have another
// size.
struct Repeats {
  bool failed = false;   // items that failed permanently
  bool changed = false;  // items whose files do not match their digests; reads every file
};

// Compares the items of a plan with the journal and the files of earlier runs, before the first
// call. During the run, it ensures that all answers of the set are made from the same leaders, and
// in the same way by whichever server.
class Survey {
 public:
  // `folder` is open and outlives the survey. Errors: ABORTED, DATA_LOSS if it cannot be written or
  // read.
  static absl::StatusOr<std::unique_ptr<Survey>> Open(const JobFolder& folder,
                                                      const Repeats& repeats);

  // Adds an item of this run's share of the plan. Call it for each item of the share, in the order
  // of the plan. Errors: FAILED_PRECONDITION, with the item or the leader, if the set was begun
  // with another plan or a leader's file has changed since; ABORTED, DATA_LOSS as in Open.
  absl::Status Add(const Item& item);

  // Of the items that were added.
  bool IsSettled(int64_t item) const {
    return item < static_cast<int64_t>(settled_.size()) && settled_[static_cast<size_t>(item)];
  }
  const JournalReader& journal() const { return journal_; }

  // Stores the digest of a leader's file, and how the answers of a model, "name@version", were
  // made. FAILED_PRECONDITION, with what differs, if the first ones were others. Takes little more
  // than 16 bytes for each file. Safe to call concurrently.
  absl::Status CheckLeader(const LeaderEntry& leader, const std::string& sha256);
  absl::Status CheckMaker(const std::string& model, const MadeBy& made_by);

 private:
  Survey(const JobFolder& folder, const Repeats& repeats, JournalReader journal)
      : folder_(folder), repeats_(repeats), journal_(std::move(journal)) {}
  absl::Status CheckRecorded(const LeaderEntry& leader, const v1::IndexEntry& record);
  bool IsSettledNow(const v1::IndexEntry& record) const;

  const JobFolder& folder_;
  const Repeats repeats_;
  JournalReader journal_;
  std::vector<bool> settled_;  // by item number

  std::mutex mutex_;
  absl::flat_hash_map<uint64_t, uint64_t> digests_;  // by hash of the path; the first 64 bits
  std::map<std::string, std::string> makers_;        // in words, by model
};

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_SURVEY_H_

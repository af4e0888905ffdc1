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
#include "client/batch/job_folder.h"
#include "client/batch/journal.h"
#include "client/batch/leaders.h"
#include "client/batch/plan.h"
#include "client/batch/record.h"

namespace duet::client::batch {

// What all answers of a data set are made from: the content of each leader's file, and one kind of
// server for each model.

// The digest of each leader's file when its first answer was made, which ensures that all answers
// of a data set are made from the same leaders. Takes little more than 16 bytes for each file.
//
// Threads: safe to call concurrently.
class LeaderDigests {
 public:
  // Whether the digest of the leader's file is known.
  bool Knows(const LeaderEntry& leader) const;
  // Stores the first digest of the leader's file. FAILED_PRECONDITION, with the leader, if `sha256`
  // differs from it.
  absl::Status Check(const LeaderEntry& leader, const std::string& sha256);

 private:
  mutable std::mutex mutex_;
  absl::flat_hash_map<uint64_t, uint64_t> digests_;  // by hash of the path; the first 64 bits
};

// How the answers of each model of a set were made, which must be the same for all of them.
//
// Threads: safe to call concurrently.
class Makers {
 public:
  // Stores how the first answer of a model, "name@version", was made. FAILED_PRECONDITION, with
  // what differs, if this one was made in another way.
  absl::Status Check(const std::string& model, const MadeBy& made_by);

 private:
  std::mutex mutex_;
  std::map<std::string, std::string> first_;  // in words, by model
};

// Which settled items a run requests again, besides those whose files are missing or have another
// size.
struct Repeats {
  bool failed = false;   // items that failed permanently
  bool changed = false;  // items whose files do not match their digests; reads every file
};

// Compares the items of a plan with the journal and the files of earlier runs, before the first
// call.
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
  // Digests of all leaders that have an answer.
  LeaderDigests& leaders() { return leaders_; }
  // How all answers were made.
  Makers& makers() { return makers_; }

 private:
  Survey(const JobFolder& folder, const Repeats& repeats, JournalReader journal)
      : folder_(folder), repeats_(repeats), journal_(std::move(journal)) {}
  absl::Status CheckLeader(const LeaderEntry& leader, const v1::IndexEntry& record);
  bool IsSettledNow(const v1::IndexEntry& record) const;

  const JobFolder& folder_;
  const Repeats repeats_;
  JournalReader journal_;
  std::vector<bool> settled_;  // by item number
  LeaderDigests leaders_;
  Makers makers_;
};

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_SURVEY_H_

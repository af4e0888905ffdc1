#ifndef DUET_CLIENT_BATCH_SURVEY_H_
#define DUET_CLIENT_BATCH_SURVEY_H_

#include <cstdint>
#include <memory>
#include <vector>

#include "absl/status/statusor.h"
#include "client/batch/job_folder.h"
#include "client/batch/journal.h"
#include "client/batch/origins.h"
#include "client/batch/plan.h"

namespace duet::client::batch {

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
  // `folder` is open and was begun, or will be begun, with `identity`; both outlive the survey.
  // Errors: ABORTED, DATA_LOSS if the folder cannot be written or read.
  static absl::StatusOr<std::unique_ptr<Survey>> Open(const JobFolder& folder,
                                                      const JobIdentity& identity,
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
  Survey(const JobFolder& folder, const JobIdentity& identity, const Repeats& repeats,
         JournalReader journal)
      : folder_(folder), identity_(identity), repeats_(repeats), journal_(std::move(journal)) {}
  absl::Status CheckLeader(const LeaderEntry& leader, const v1::IndexEntry& record);
  bool IsSettledNow(const v1::IndexEntry& record) const;

  const JobFolder& folder_;
  const JobIdentity& identity_;
  const Repeats repeats_;
  JournalReader journal_;
  std::vector<bool> settled_;  // by item number
  LeaderDigests leaders_;
  Makers makers_;
};

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_SURVEY_H_

#ifndef DUET_CLIENT_BATCH_SURVEY_H_
#define DUET_CLIENT_BATCH_SURVEY_H_

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "absl/status/statusor.h"
#include "client/batch/job_folder.h"
#include "client/batch/journal.h"
#include "client/batch/leader_digests.h"
#include "client/batch/plan.h"
#include "client/batch/shard_list.h"

namespace duet::client::batch {

// The part of a plan that a run settles. JobOptions has fields of the same names.
struct SurveyedPart {
  int64_t limit = std::numeric_limits<int64_t>::max();
  double share = 1;
  bool retry_failed = false;
};

// The state of a plan after earlier runs, taken before the first call.
struct Survey {
  JournalReader journal;
  ShardList shards;
  // By item number, only for items of the part: whether the item is settled and its files exist
  // with their sizes. The files are not read.
  std::vector<bool> settled;
  int64_t planned = 0;      // items of the part in the job's shard
  bool whole_plan = false;  // whether these are all items
  bool all_packed = true;   // whether all done items are in a shard
  // Digests of all leaders that have an answer.
  std::unique_ptr<LeaderDigests> leaders;

  bool IsSettled(int64_t item) const {
    return item < static_cast<int64_t>(settled.size()) && settled[static_cast<size_t>(item)];
  }
};

// Reads the plan to its end, and removes damaged lines of the journal. `folder` is open and was
// begun, or will be begun, with `identity`.
//
// Errors: those of the plan; FAILED_PRECONDITION, with the item or the leader, if the set was begun
// with
//         another plan or a leader's file has changed since; ABORTED, DATA_LOSS if the folder
//         cannot be written or read.
absl::StatusOr<Survey> TakeSurvey(const JobFolder& folder, const JobIdentity& identity,
                                  const SurveyedPart& part, Plan* plan);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_SURVEY_H_

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

// What of a plan a run is to settle: as JobOptions of the same names.
struct SurveyedPart {
  int64_t limit = std::numeric_limits<int64_t>::max();
  double share = 1;
  bool retry_failed = false;
};

// What earlier runs left of a plan; taken before anything is asked for.
struct Survey {
  JournalReader journal;
  ShardList shards;
  // By the number of the item, for those of the part alone: whether it is settled, and its files
  // are there as far as a look without reading them tells.
  std::vector<bool> settled;
  int64_t planned = 0;      // items of the part and the job's shard
  bool whole_plan = false;  // which are all that there are
  bool all_packed = true;   // every one of them that is done is in a shard
  // Of every leader that has an answer.
  std::unique_ptr<LeaderDigests> leaders;

  bool IsSettled(int64_t item) const {
    return item < static_cast<int64_t>(settled.size()) && settled[static_cast<size_t>(item)];
  }
};

// Goes through the plan from where it is, and removes damaged lines of the journal. `folder` is
// open; `identity` is what it was begun with, or will be.
//
// Errors: the plan's; FAILED_PRECONDITION, naming the item or the leader, where the plan is not
//         the one that the set was begun with, or a leader's file was changed since; ABORTED,
//         DATA_LOSS where the folder cannot be written or read.
absl::StatusOr<Survey> TakeSurvey(const JobFolder& folder, const JobIdentity& identity,
                                  const SurveyedPart& part, Plan* plan);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_SURVEY_H_

#ifndef DUET_CLIENT_BATCH_ESTIMATE_H_
#define DUET_CLIENT_BATCH_ESTIMATE_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/batch/plan.h"
#include "client/batch/shard.h"
#include "client/client.h"
#include "model/motion/skeleton.h"

namespace duet::client::batch {

// What a job would be.
struct Estimate {
  int64_t items = 0;
  int64_t leaders = 0;  // people who lead, as often as they are listed
  int64_t frames = 0;   // of all followers
  // From one answer: for all items one after the other, and of all files. 0 where no leader can be
  // read.
  double seconds = 0;
  double bytes = 0;
  int64_t unreadable = 0;             // leaders that cannot be read
  std::vector<std::string> problems;  // why, of the first twenty
};

// Reads every leader of the plan's first `limit` items, and asks for the first item. Writes
// nothing. Errors: the plan's, and what the server says to that item.
absl::StatusOr<Estimate> EstimateJob(const Recipe& recipe, const std::vector<ModelInfo>& models,
                                     const std::vector<motion::Skeleton>& skeletons,
                                     const Shard& shard, int64_t limit, const Client& client,
                                     Plan* plan);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_ESTIMATE_H_

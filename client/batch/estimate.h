#ifndef DUET_CLIENT_BATCH_ESTIMATE_H_
#define DUET_CLIENT_BATCH_ESTIMATE_H_

#include <vector>

#include "absl/status/statusor.h"
#include "client/batch/plan_check.h"
#include "client/client.h"
#include "model/motion/skeleton.h"

namespace duet::client::batch {

// The cost of a job, estimated from one answer. 0 if no leader can be used.
struct Estimate {
  double seconds = 0;  // for all items, one after the other
  double bytes = 0;    // of all files
};

// Requests the first item of a checked plan. Writes nothing. Errors: those of the call.
absl::StatusOr<Estimate> EstimateJob(const Recipe& recipe, const std::vector<ModelInfo>& models,
                                     const std::vector<motion::Skeleton>& skeletons,
                                     const RequestLimits& limits, const PlanCheck& check,
                                     const Client& client);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_ESTIMATE_H_

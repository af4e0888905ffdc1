#ifndef DUET_CLIENT_BATCH_PLAN_CHECK_H_
#define DUET_CLIENT_BATCH_PLAN_CHECK_H_

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/batch/loaded_leader.h"
#include "client/batch/plan.h"
#include "client/batch/shard.h"
#include "client/client.h"
#include "client/result.h"
#include "model/motion/skeleton.h"

namespace duet::client::batch {

// The items of a plan that a run makes.
struct PlanPart {
  Shard shard;
  int64_t limit = std::numeric_limits<int64_t>::max();  // only the first items of the plan
  double share = 1;
  // If not empty, is called for each item of the part, in the order of the plan and up to the first
  // bad line, which shifts the numbers of items. Leaders of settled items are not read. An error
  // ends the check.
  std::function<absl::StatusOr<bool>(const Item&)> is_settled;
  bool Has(const Item& item) const;
};

// A leader that cannot be used, however often it is listed.
struct BadLeader {
  std::string message;  // names the file
  int64_t items = 0;    // of the part that fail because of it
};

// The result of checking a plan before the first call.
struct PlanCheck {
  int64_t items = 0;        // of the part, including settled ones
  bool whole_plan = false;  // whether the part, before sharding, has all items of the plan
  int64_t leaders = 0;      // leading people, counted as often as they are listed
  int64_t files = 0;        // different leaders, as listed
  int64_t frames = 0;       // of all followers, at the output rate
  double seconds = 0;       // the same as a duration

  // Invalid lines of a manifest and leaders that cannot be used, in the order of the list; at most
  // kListed of each are stored.
  static constexpr size_t kListed = 1000;
  int64_t bad_line_count = 0;
  std::vector<std::string> bad_lines;  // "FILE:LINE: FIELD: expected ..., got ..."
  int64_t bad_leader_count = 0;
  std::vector<BadLeader> bad_leaders;
  int64_t items_of_bad_leaders = 0;

  // The first item whose leader can be used.
  std::optional<Item> first_item;
};

// Reads the plan to its end, every line of its manifest, and the leaders of the part. `skeletons`
// are the models'. `stopped` is called between items; once it returns true, the check ends with
// what it has. Errors: those that end the plan, and those of `part.is_settled`.
//
// Threads: reads leaders in threads of its own.
absl::StatusOr<PlanCheck> CheckPlan(
    const Recipe& recipe, const std::vector<motion::Skeleton>& skeletons,
    const RequestLimits& limits, const PlanPart& part, Plan* plan,
    const std::function<bool()>& stopped = [] { return false; });

// INVALID_ARGUMENT with a list of the bad lines, if the plan has any: its run must not begin.
absl::Status BadLinesError(const PlanCheck& check);

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

#endif  // DUET_CLIENT_BATCH_PLAN_CHECK_H_

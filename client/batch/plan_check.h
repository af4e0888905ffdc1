#ifndef DUET_CLIENT_BATCH_PLAN_CHECK_H_
#define DUET_CLIENT_BATCH_PLAN_CHECK_H_

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/batch/plan.h"

namespace duet::client::batch {

// The items of a plan that a run makes.
struct PlanPart {
  Shard shard;
  int64_t limit = std::numeric_limits<int64_t>::max();  // only the first items of the plan
  bool Has(const Item& item) const { return item.number < limit && shard.Has(item.place); }
};

// The result of checking a plan before the first call.
struct PlanCheck {
  int64_t items = 0;    // of the part
  int64_t leaders = 0;  // leading people, counted as often as they are listed
  int64_t files = 0;    // different leaders, as listed

  // Invalid lines of a manifest, in the order of the list; at most kListed are stored.
  static constexpr size_t kListed = 1000;
  int64_t bad_line_count = 0;
  std::vector<std::string> bad_lines;  // "FILE:LINE: FIELD: expected ..., got ..."
};

// Reads the plan to its end. `visit` is called for each item of the part, in the order of the plan
// and up to the first bad line, which shifts the numbers of items; its error ends the check.
// `stopped` is called between items; once it returns true, the check ends with what it has. Errors:
// those that end the plan, and those of `visit`.
absl::StatusOr<PlanCheck> CheckPlan(
    const PlanPart& part, Plan* plan, const std::function<absl::Status(const Item&)>& visit,
    const std::function<bool()>& stopped = [] { return false; });

// INVALID_ARGUMENT with a list of the bad lines, if the plan has any: its run must not begin.
absl::Status BadLinesError(const PlanCheck& check);

}  // namespace duet::client::batch

#endif  // DUET_CLIENT_BATCH_PLAN_CHECK_H_

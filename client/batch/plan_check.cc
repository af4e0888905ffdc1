#include "client/batch/plan_check.h"

#include <memory>

#include "absl/container/flat_hash_set.h"
#include "absl/hash/hash.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/base/counted.h"

namespace duet::client::batch {

absl::StatusOr<PlanCheck> CheckPlan(const PlanPart& part, Plan* plan,
                                    const std::function<absl::Status(const Item&)>& visit,
                                    const std::function<bool()>& stopped) {
  PlanCheck check;
  absl::flat_hash_set<size_t> files;  // hashes of leaders as listed
  std::shared_ptr<const LeaderEntry> last_leader;
  formats::Side last_side = formats::Side::kLeft;
  while (!stopped()) {
    const absl::StatusOr<std::optional<Item>> next = plan->Next();
    if (absl::IsInvalidArgument(next.status())) {
      if (check.bad_line_count++ >= static_cast<int64_t>(PlanCheck::kListed)) continue;
      check.bad_lines.emplace_back(next.status().message());
      continue;
    }
    if (!next.ok()) return next.status();
    if (!next->has_value()) break;
    const Item& item = **next;
    if (!part.Has(item)) continue;
    ++check.items;
    if (item.leader != last_leader || item.side != last_side) ++check.leaders;
    if (item.leader != last_leader) files.insert(absl::Hash<std::string>()(item.leader->given));
    last_leader = item.leader;
    last_side = item.side;
    if (check.bad_line_count > 0) continue;
    absl::Status status = visit(item);
    if (!status.ok()) return status;
  }
  check.files = static_cast<int64_t>(files.size());
  return check;
}

absl::Status BadLinesError(const PlanCheck& check) {
  if (check.bad_line_count == 0) return absl::OkStatus();
  std::string lines = absl::StrJoin(check.bad_lines, "\n  ");
  const auto more = check.bad_line_count - static_cast<int64_t>(check.bad_lines.size());
  if (more > 0) absl::StrAppend(&lines, "\n  and ", more, " more");
  return absl::InvalidArgumentError(absl::StrCat(base::Counted(check.bad_line_count, "bad line"),
                                                 "; no call was made:\n  ", lines));
}

}  // namespace duet::client::batch

#ifndef DUET_CLIENT_CLI_BATCH_PLAN_H_
#define DUET_CLIENT_CLI_BATCH_PLAN_H_

#include <atomic>
#include <cstdint>
#include <istream>
#include <string>
#include <thread>
#include <vector>

#include "absl/status/statusor.h"
#include "client/batch/plan.h"
#include "client/batch/shard.h"
#include "client/cli/arguments.h"
#include "client/result.h"

namespace duet::client::cli {

// The plan of the leaders that the flags name; `in` is what a manifest named "-" is read from. What
// was passed over in folders is added to `passed_over`, which may be null.
absl::StatusOr<batch::Plan> MakePlan(const BatchArguments& arguments, const batch::Recipe& recipe,
                                     const std::vector<ModelInfo>& models, std::istream* in,
                                     std::vector<std::string>* passed_over);

// Counts the items of a plan in a thread of its own, so that the time left can be told. A plan that
// is not OK is not counted.
class Counting {
 public:
  Counting(absl::StatusOr<batch::Plan> plan, const batch::Shard& shard, int64_t limit);
  Counting(const Counting&) = delete;
  Counting& operator=(const Counting&) = delete;
  ~Counting();
  // -1 while it is not known.
  const std::atomic<int64_t>& total() const { return total_; }

 private:
  std::atomic<bool> ended_{false};
  std::atomic<int64_t> total_{-1};
  std::thread thread_;
};

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_BATCH_PLAN_H_

#ifndef DUET_MODEL_EVALUATION_BASELINES_BASELINES_H_
#define DUET_MODEL_EVALUATION_BASELINES_BASELINES_H_

#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "model/evaluation/protocol/protocol.h"

namespace duet::evaluation::baselines {

// The two trivial rows, then the rows of Table 1 that need no network, in the order of the table.
std::vector<std::string> BaselineNames();

// A baseline by its name, untrained, with its published settings (docs/baselines.md). Its training
// discards the results of an earlier one, and fails with INVALID_ARGUMENT for a class of the data
// set without a training sequence. Errors: INVALID_ARGUMENT for a name that is not in
// BaselineNames.
absl::StatusOr<std::unique_ptr<protocol::Method>> MakeBaseline(const std::string& name);

}  // namespace duet::evaluation::baselines

#endif  // DUET_MODEL_EVALUATION_BASELINES_BASELINES_H_

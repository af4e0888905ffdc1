#ifndef DUET_CLIENT_CLI_COMPARISON_REPORT_H_
#define DUET_CLIENT_CLI_COMPARISON_REPORT_H_

#include <string>

#include "absl/status/statusor.h"
#include "client/analysis/comparison.h"
#include "client/cli/style.h"
#include "client/cli/take.h"
#include "model/motion/skeleton.h"
#include "nlohmann/json_fwd.hpp"

namespace duet::client::cli {

// Two takes and how they differ.
struct ComparedTakes {
  Take a, b;
  analysis::Comparison comparison;
};

std::string DescribeComparison(const ComparedTakes& compared, const Style& style);
nlohmann::json ComparisonJson(const ComparedTakes& compared, const motion::Skeleton& skeleton);
// A page that plays both beside all figures.
absl::StatusOr<std::string> RenderComparison(const ComparedTakes& compared,
                                             const motion::Skeleton& skeleton);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_COMPARISON_REPORT_H_

#include "client/cli/compare_command.h"

#include <ostream>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/cli/comparison_report.h"
#include "client/cli/output.h"
#include "client/cli/report.h"
#include "model/base/file.h"
#include "nlohmann/json.hpp"

namespace duet::client::cli {
namespace {

// Of two people the follower is compared, the leader its partner.
analysis::Answer AnswerOf(const Take& take) {
  if (take.follower) return {*take.follower, take.leader};
  return {take.leader, std::nullopt};
}

absl::StatusOr<ComparedTakes> CompareTakes(const TakeArguments& arguments,
                                           const motion::Skeleton& skeleton, std::istream* in) {
  absl::StatusOr<std::vector<Take>> takes = ReadTakes(arguments, skeleton, in);
  if (!takes.ok()) return takes.status();
  if (takes->size() != 2) {
    return absl::InvalidArgumentError(
        "files: the second is the follower of the first, wanted two motions");
  }
  ComparedTakes compared;
  compared.a = std::move((*takes)[0]);
  compared.b = std::move((*takes)[1]);
  absl::StatusOr<analysis::Comparison> comparison =
      Compare(AnswerOf(compared.a), AnswerOf(compared.b), skeleton);
  if (!comparison.ok()) return comparison.status();
  compared.comparison = *std::move(comparison);
  return compared;
}

}  // namespace

absl::Status RunCompare(const CompareArguments& arguments, const ProgramEnvironment& environment) {
  const motion::Skeleton skeleton = motion::SbuSkeleton();
  const absl::StatusOr<ComparedTakes> compared =
      CompareTakes(arguments.takes, skeleton, environment.in);
  if (!compared.ok()) return compared.status();
  if (!arguments.out.empty()) {
    const absl::StatusOr<std::string> page = RenderComparison(*compared, skeleton);
    if (!page.ok()) return page.status();
    const absl::Status status = NotWritten(base::WriteFile(arguments.out, *page));
    if (!status.ok()) return status;
  }
  *environment.out << (arguments.json ? Print(ComparisonJson(*compared, skeleton))
                                      : DescribeComparison(*compared, environment.OutStyle()));
  if (!arguments.out.empty() && !arguments.json) {
    *environment.out << "\nwrote     " << arguments.out.string() << "\n";
  }
  return absl::OkStatus();
}

}  // namespace duet::client::cli

#include "client/cli/compare_command.h"

#include <memory>
#include <ostream>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/cli/comparison_report.h"
#include "client/cli/flags.h"
#include "client/cli/input_flags.h"
#include "client/cli/output.h"
#include "client/cli/report.h"
#include "client/cli/take_flags.h"
#include "model/base/file.h"
#include "nlohmann/json.hpp"

namespace duet::client::cli {
namespace {

struct CompareArguments {
  TakeArguments takes;  // two
  std::filesystem::path out;
  bool json = false;
};

// If a take has two people, compares the follower, with the leader as its partner.
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
        "files: expected two motions, got one: the second is the follower of the first");
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

void AddFlags(FlagSet* command, CompareArguments* arguments) {
  command
      ->Add("files", &arguments->takes.takes,
            "The two motions; of two people each, their followers are compared")
      ->Required()
      ->Count(2, 2)
      ->Form("[NAME=]FILE");
  AddTakeFlags(command, &arguments->takes);
  command->AddSwitch("--json", &arguments->json, "Print JSON")->Group(kOutputGroup);
  command->Add("--out", &arguments->out, "Page to write with both motions and all figures, .html")
      ->Form("FILE")
      ->Group(kOutputGroup);
  command->Footer(kTakesFooter);
  command->Check([command, arguments] {
    CheckTakes(arguments->takes);
    if (arguments->out == kStandardStream) {
      RejectFlag("--out", "expected a file, got standard output");
    }
    if (!arguments->out.empty()) CheckPage("--out", arguments->out);
  });
}

}  // namespace

Command AddCompareCommand(FlagSet* program) {
  const auto arguments = std::make_shared<CompareArguments>();
  FlagSet* app = program->AddCommand(
      "compare", "Print how two motions differ: displacement, speed, lean, contact");
  AddFlags(app, arguments.get());
  return MakeCommand(app, arguments, RunCompare);
}

}  // namespace duet::client::cli

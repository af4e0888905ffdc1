#ifndef DUET_CLIENT_CLI_BATCH_REPORT_H_
#define DUET_CLIENT_CLI_BATCH_REPORT_H_

#include <filesystem>
#include <string>
#include <vector>

#include "client/batch/estimate.h"
#include "client/batch/job.h"
#include "client/batch/merge.h"
#include "client/batch/plan_check.h"
#include "client/batch/verify.h"
#include "client/cli/arguments.h"
#include "client/cli/program.h"

namespace duet::client::cli {

// What duet batch says of what it did: a sentence, or with --json an event or an object a line.
void Report(const BatchArguments& arguments, const std::filesystem::path& folder,
            const batch::JobReport& report, const ProgramEnvironment& environment);
// Of a dry run. What is wrong goes to the error stream.
void Report(const BatchArguments& arguments, const batch::PlanCheck& check,
            const batch::Estimate& estimate, const ProgramEnvironment& environment);
// Of a run that is about to begin: leaders that its items will fail by, if there are any.
void ReportBadLeaders(const BatchArguments& arguments, const batch::PlanCheck& check,
                      const ProgramEnvironment& environment);
void Report(const BatchArguments& arguments, const batch::MergeReport& report,
            const ProgramEnvironment& environment);
void Report(const BatchArguments& arguments, const batch::VerifyReport& report,
            const ProgramEnvironment& environment);

// Names the first of the files that folders hold beside motions.
void ReportPassedOver(const BatchArguments& arguments, const std::vector<std::string>& files,
                      const ProgramEnvironment& environment);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_BATCH_REPORT_H_

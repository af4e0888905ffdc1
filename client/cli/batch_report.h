#ifndef DUET_CLIENT_CLI_BATCH_REPORT_H_
#define DUET_CLIENT_CLI_BATCH_REPORT_H_

#include <filesystem>
#include <string>
#include <vector>

#include "client/batch/gather.h"
#include "client/batch/job.h"
#include "client/batch/plan_check.h"
#include "client/cli/batch_arguments.h"
#include "client/cli/program_environment.h"

namespace duet::client::cli {

// The output of duet batch: sentences, or with --json one event or object on each line.
// `failures_allowed`: --allow-failed permits the leaders that failed.
void Report(const BatchArguments& arguments, const std::filesystem::path& folder,
            const batch::JobReport& report, bool failures_allowed,
            const ProgramEnvironment& environment);
// For a dry run. Problems go to the error stream.
void Report(const BatchArguments& arguments, const batch::PlanCheck& check,
            const batch::Estimate& estimate, const ProgramEnvironment& environment);
// Before a run: the leaders that cannot be used, if there are any.
void ReportBadLeaders(const BatchArguments& arguments, const batch::PlanCheck& check,
                      const ProgramEnvironment& environment);
// The shards of the job that the run has joined, if there are any.
void ReportGathered(const BatchArguments& arguments, const batch::Gathered& gathered,
                    const ProgramEnvironment& environment);
// What an index.tsv decided.
void ReportIndexedSides(const BatchArguments& arguments, const batch::IndexedSides& sides,
                        const ProgramEnvironment& environment);
// The first of the files in folders that are not motions.
void ReportPassedOver(const BatchArguments& arguments, const std::vector<std::string>& files,
                      const ProgramEnvironment& environment);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_BATCH_REPORT_H_

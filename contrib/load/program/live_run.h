#ifndef DUET_CONTRIB_LOAD_PROGRAM_LIVE_RUN_H_
#define DUET_CONTRIB_LOAD_PROGRAM_LIVE_RUN_H_

#include "absl/status/statusor.h"
#include "contrib/load/live_report.h"
#include "contrib/load/program/load_flags.h"
#include "contrib/load/program/load_program.h"

namespace duet::contrib::load::program {

// Runs `duet-load --live`, step by step. Returns the measurements, without a head.
// Errors: INVALID_ARGUMENT for flags that --live cannot use and for leaders that cannot be read;
// the server's status if it does not have the model.
absl::StatusOr<LiveReport> RunLiveSteps(const LoadArguments& arguments,
                                        const LoadEnvironment& environment);

}  // namespace duet::contrib::load::program

#endif  // DUET_CONTRIB_LOAD_PROGRAM_LIVE_RUN_H_

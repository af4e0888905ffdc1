#include "client/cli/program.h"

#include <ostream>
#include <string>

#include "absl/strings/str_join.h"
#include "client/cli/arguments.h"
#include "client/cli/batch_command.h"
#include "client/cli/exit_code.h"
#include "client/cli/models_command.h"
#include "client/cli/report.h"
#include "client/cli/synthesize_command.h"

namespace duet::client::cli {

int RunProgram(const std::vector<std::string>& arguments, const ProgramEnvironment& environment) {
  const ParsedCommandLine parsed = ParseCommandLine(arguments);
  absl::Status status;
  std::string server;
  if (parsed.models.has_value()) {
    server = parsed.models->server.address;
    status = RunModels(*parsed.models, environment);
  } else if (parsed.synthesize.has_value()) {
    server = parsed.synthesize->server.address;
    status = RunSynthesize(*parsed.synthesize, environment);
  } else if (parsed.batch.has_value()) {
    server = absl::StrJoin(parsed.batch->servers, ", ");
    const absl::StatusOr<ExitCode> code = RunBatch(*parsed.batch, environment);
    if (code.ok()) return *code;
    status = code.status();
  } else {
    (parsed.exit_code == kExitDone ? *environment.out : *environment.err) << parsed.text;
    return parsed.exit_code;
  }
  if (!status.ok()) *environment.err << DescribeFailure(status, server);
  return ExitCodeFor(status);
}

}  // namespace duet::client::cli

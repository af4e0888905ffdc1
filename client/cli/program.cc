#include "client/cli/program.h"

#include <ostream>
#include <string>

#include "absl/strings/match.h"
#include "absl/strings/str_join.h"
#include "client/cli/admin_command.h"
#include "client/cli/arguments.h"
#include "client/cli/batch_command.h"
#include "client/cli/command_line.h"
#include "client/cli/compare_command.h"
#include "client/cli/convert_command.h"
#include "client/cli/exit_code.h"
#include "client/cli/inspect_command.h"
#include "client/cli/man_page.h"
#include "client/cli/models_command.h"
#include "client/cli/report.h"
#include "client/cli/stdio_command.h"
#include "client/cli/synthesize_command.h"
#include "client/cli/view_command.h"

namespace duet::client::cli {
namespace {

// Help works whatever the settings are.
bool NeedsSettings(const std::vector<std::string>& arguments) {
  if (arguments.empty() || absl::StartsWith(arguments[0], "-")) return false;
  return arguments[0] != "help" && arguments[0] != "completion" && arguments[0] != "man";
}

absl::StatusOr<ExitCode> Done(const absl::Status& status) {
  if (!status.ok()) return status;
  return kExitDone;
}

// `server` receives where a command looks for servers.
absl::StatusOr<ExitCode> RunCommand(const ParsedCommandLine& parsed,
                                    const ProgramEnvironment& environment, std::string* server) {
  if (parsed.models.has_value()) {
    *server = parsed.models->server.address;
    return Done(RunModels(*parsed.models, environment));
  }
  if (parsed.admin.has_value()) {
    *server = parsed.admin->server.address;
    return RunAdmin(*parsed.admin, environment);
  }
  if (parsed.synthesize.has_value()) {
    *server = parsed.synthesize->server.address;
    return Done(RunSynthesize(*parsed.synthesize, environment));
  }
  if (parsed.batch.has_value()) {
    const BatchArguments& batch = *parsed.batch;
    *server = absl::StrJoin(batch.repairers.empty() ? batch.servers : batch.repairers, ", ");
    return RunBatch(*parsed.batch, environment);
  }
  if (parsed.inspect.has_value()) return RunInspect(*parsed.inspect, environment);
  if (parsed.convert.has_value()) return Done(RunConvert(*parsed.convert, environment));
  if (parsed.view.has_value()) return Done(RunView(*parsed.view, environment));
  if (parsed.compare.has_value()) return Done(RunCompare(*parsed.compare, environment));
  if (parsed.stdio) return RunStdio(environment);
  if (parsed.man.has_value()) return Done(WriteManualPages(CommandLine().app, parsed.man->folder));
  (parsed.exit_code == kExitDone ? *environment.out : *environment.err) << parsed.text;
  return static_cast<ExitCode>(parsed.exit_code);
}

}  // namespace

int RunProgram(const std::vector<std::string>& arguments, const ProgramEnvironment& environment) {
  std::vector<Setting> settings;
  if (NeedsSettings(arguments)) {
    absl::StatusOr<std::vector<Setting>> read = ReadSettings(environment.variables);
    if (!read.ok()) {
      *environment.err << DescribeFailure(read.status(), "", environment.ErrStyle());
      return kExitUsage;
    }
    settings = *std::move(read);
  }
  std::string server;
  const absl::StatusOr<ExitCode> code =
      RunCommand(ParseCommandLine(arguments, settings), environment, &server);
  if (code.ok()) return *code;
  *environment.err << DescribeFailure(code.status(), server, environment.ErrStyle());
  return ExitCodeFor(code.status());
}

}  // namespace duet::client::cli

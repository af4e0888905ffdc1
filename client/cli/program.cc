#include "client/cli/program.h"

#include <ostream>
#include <utility>

#include "client/cli/command_line.h"
#include "client/cli/exit_code.h"
#include "client/cli/report.h"

namespace duet::client::cli {

int RunProgram(const std::vector<std::string>& arguments, const ProgramEnvironment& environment) {
  CommandLine line;
  std::vector<Setting> settings;
  if (line.UsesSettings(arguments)) {
    absl::StatusOr<std::vector<Setting>> read = ReadSettings(environment.variables);
    if (!read.ok()) {
      *environment.err << DescribeFailure(read.status(), "", environment.ErrStyle());
      return kExitUsage;
    }
    settings = *std::move(read);
  }
  const ParsedCommandLine parsed = line.Parse(arguments, settings);
  if (parsed.command == nullptr) {
    (parsed.exit_code == kExitDone ? *environment.out : *environment.err) << parsed.text;
    return parsed.exit_code;
  }
  const absl::StatusOr<ExitCode> code =
      parsed.command->run({line.app(), parsed.words, environment, RunProgram});
  if (code.ok()) return *code;
  *environment.err << DescribeFailure(code.status(), parsed.command->servers(),
                                      environment.ErrStyle());
  return ExitCodeFor(code.status());
}

}  // namespace duet::client::cli

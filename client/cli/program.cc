#include <ostream>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/cli/command.h"
#include "client/cli/report.h"
#include "model/base/text.h"

namespace duet::client::cli {

int RunProgram(const std::vector<std::string>& arguments, const ProgramEnvironment& environment) {
  CLI::App app("Asks a Duet server to answer one character's motion with another's.", "duet");
  app.get_formatter()->column_width(34);
  app.set_version_flag("--version", "duet " DUET_VERSION);
  app.require_subcommand(1);
  app.footer(kExitCodesFooter);
  std::vector<Command> commands;
  for (const auto add : {AddModelsCommand, AddSynthesizeCommand, AddLiveCommand, AddBatchCommand,
                         AddInspectCommand, AddConvertCommand, AddViewCommand, AddAdminCommand}) {
    commands.push_back(add(&app));
  }
  app.set_help_all_flag("--help-all", "Print the help of all commands and exit");
  try {
    // CLI11 takes the arguments in reverse.
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::Success& answer) {  // --help or --version
    return app.exit(answer, *environment.out, *environment.err);
  } catch (const CLI::ParseError& error) {
    // CLI11 does not name a first word that is no command.
    const bool unknown = app.get_subcommands().empty() && !arguments.empty();
    *environment.err << (unknown
                             ? absl::StrCat("Expected a command, got ", base::Quoted(arguments[0]))
                             : std::string(error.what()))
                     << "\nRun with --help for more information.\n";
    return kExitUsage;
  }
  for (const Command& command : commands) {
    if (!command.app->parsed()) continue;
    const absl::StatusOr<ExitCode> code = command.run(environment);
    if (code.ok()) return *code;
    *environment.err << DescribeFailure(code.status(), command.servers());
    return ExitCodeFor(code.status());
  }
  return kExitUsage;  // not reached: a command is required
}

}  // namespace duet::client::cli

#include <ostream>
#include <string>
#include <vector>

#include "absl/algorithm/container.h"
#include "absl/status/status.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/cli/command.h"
#include "client/cli/program_environment.h"
#include "client/cli/report.h"
#include "model/base/nearest.h"
#include "model/base/text.h"
#include "model/base/usage_text.h"

namespace duet::client::cli {
namespace {

using Strings = std::vector<std::string>;

int PrintUsageError(const std::string& message, const ProgramEnvironment& environment) {
  *environment.err << message << "\nRun with --help for more information.\n";
  return kExitUsage;
}

const CLI::App* FindCommand(const CLI::App& app, const std::string& name) {
  for (const CLI::App* command : app.get_subcommands({})) {
    if (command->get_name() == name) return command;
  }
  return nullptr;
}

// The error about a first word that is not a command; empty if it is one.
std::string FindUnknownCommand(const CLI::App& app, const Strings& arguments) {
  if (arguments.empty() || absl::StartsWith(arguments[0], "-")) return "";
  if (FindCommand(app, arguments[0]) != nullptr) return "";
  Strings known;
  for (const CLI::App* command : app.get_subcommands({})) known.push_back(command->get_name());
  return absl::StrCat("There is no command ", base::Quoted(arguments[0]),
                      base::DidYouMean(arguments[0], known));
}

// The names of the flags of a command and of its actions.
void AddFlagsOf(const CLI::App& command, Strings* names) {
  for (const CLI::Option* option : command.get_options()) {
    if (!option->get_positional()) names->push_back(option->get_name());
  }
  for (const CLI::App* action : command.get_subcommands({})) AddFlagsOf(*action, names);
}

// The error about the first flag that the command does not have; empty if there is none.
std::string FindUnknownFlag(const CLI::App& app, const Strings& arguments) {
  const CLI::App* command = arguments.empty() ? nullptr : FindCommand(app, arguments[0]);
  if (command == nullptr) return "";
  Strings known;
  AddFlagsOf(*command, &known);
  for (const std::string& argument : arguments) {
    if (argument == "--") break;
    const std::string flag = argument.substr(0, argument.find('='));
    if (!absl::StartsWith(flag, "--") || absl::c_linear_search(known, flag)) continue;
    return absl::StrCat(arguments[0], " has no flag ", flag, base::DidYouMean(flag, known));
  }
  return "";
}

}  // namespace

int RunProgram(const Strings& arguments, const ProgramEnvironment& environment) {
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
  const std::string unknown = FindUnknownCommand(app, arguments);
  if (!unknown.empty()) return PrintUsageError(unknown, environment);
  try {
    // CLI11 takes the arguments in reverse.
    app.parse(Strings(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::Success& answer) {  // --help or --version
    return app.exit(answer, *environment.out, *environment.err);
  } catch (const CLI::ParseError& error) {
    // An unknown flag may cause other errors: its value counts as one argument more.
    const std::string flag = FindUnknownFlag(app, arguments);
    return PrintUsageError(flag.empty() ? base::UsageText(error.what()) : flag, environment);
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

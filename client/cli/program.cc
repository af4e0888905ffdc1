#include <algorithm>
#include <ostream>
#include <string>
#include <vector>

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

// "--server" of "--server" and "--server=lab:50051".
std::string FlagOf(const std::string& argument) { return argument.substr(0, argument.find('=')); }

bool IsGiven(const std::string& flag, const Strings& arguments) {
  for (const std::string& argument : arguments) {
    if (argument == "--") return false;
    if (FlagOf(argument) == flag) return true;
  }
  return false;
}

Strings FlagsOf(const CLI::App& command) {
  Strings names;
  for (const CLI::Option* option : command.get_options()) {
    if (!option->get_positional()) names.push_back(option->get_name());
  }
  return names;
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
  if (FindCommand(app, arguments[0]) != nullptr || IsGiven("--help", arguments)) return "";
  Strings known;
  for (const CLI::App* command : app.get_subcommands({})) known.push_back(command->get_name());
  return absl::StrCat("There is no command ", base::Quoted(arguments[0]),
                      base::DidYouMean(arguments[0], known));
}

// "; did you mean --admin-server?" for --server, of which the known flag is a longer form, or for a
// flag with another spelling.
std::string SuggestedFlag(const std::string& flag, const Strings& known) {
  for (const std::string& name : known) {
    if (absl::EndsWith(name, flag.substr(1))) return absl::StrCat("; did you mean ", name, "?");
  }
  return base::DidYouMean(flag, known);
}

// The error about the first flag that the command does not have; empty if there is none.
std::string FindUnknownFlag(const CLI::App& app, const Strings& arguments) {
  const CLI::App* command = arguments.empty() ? nullptr : FindCommand(app, arguments[0]);
  if (command == nullptr) return "";
  Strings known = FlagsOf(*command);
  for (const CLI::App* subcommand : command->get_subcommands({})) {
    const Strings further = FlagsOf(*subcommand);
    known.insert(known.end(), further.begin(), further.end());
  }
  for (const std::string& argument : arguments) {
    if (argument == "--") break;
    if (!absl::StartsWith(argument, "--")) continue;
    const std::string flag = FlagOf(argument);
    if (std::find(known.begin(), known.end(), flag) != known.end()) continue;
    return absl::StrCat(arguments[0], " has no flag ", flag, SuggestedFlag(flag, known));
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

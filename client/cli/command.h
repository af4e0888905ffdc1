#ifndef DUET_CLIENT_CLI_COMMAND_H_
#define DUET_CLIENT_CLI_COMMAND_H_

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "client/cli/exit_code.h"
#include "client/cli/flag_set.h"
#include "client/cli/program_environment.h"

namespace duet::client::cli {

// What a command runs with.
struct CommandContext {
  const FlagSet& program;                 // all commands with their flags
  const std::vector<std::string>& words;  // the command line, with the settings that apply
  const ProgramEnvironment& environment;
  // Runs another command line and returns its exit code.
  int (*run_program)(const std::vector<std::string>& words, const ProgramEnvironment& environment);
};

// A command of the program. Its file defines a function that adds it to the program's FlagSet and
// returns it; client/cli/commands.cc lists these functions.
struct Command {
  FlagSet* app = nullptr;  // its name, help and flags
  // Runs after its flags were parsed. The program reports the error, if any.
  std::function<absl::StatusOr<ExitCode>(const CommandContext&)> run;
  // The servers that it calls, for error messages.
  std::function<std::string()> servers = [] { return std::string(); };
  // Whether settings apply. Commands that explain the program work with broken settings too.
  bool uses_settings = true;
};

// The exit code of a command that either succeeds or fails with `status`.
inline absl::StatusOr<ExitCode> Done(const absl::Status& status) {
  if (!status.ok()) return status;
  return kExitDone;
}
inline absl::StatusOr<ExitCode> Done(absl::StatusOr<ExitCode> code) { return code; }

// A command that runs `run` with the arguments that `app` fills in. `run` returns a status, or a
// status or an exit code.
template <typename Arguments, typename Result>
Command MakeCommand(FlagSet* app, std::shared_ptr<Arguments> arguments,
                    Result (*run)(const Arguments&, const ProgramEnvironment&)) {
  Command command;
  command.app = app;
  command.run = [arguments = std::move(arguments), run](const CommandContext& context) {
    return Done(run(*arguments, context.environment));
  };
  return command;
}

// The same for a command that calls the server `arguments->server`.
template <typename Arguments, typename Result>
Command MakeServerCommand(FlagSet* app, const std::shared_ptr<Arguments>& arguments,
                          Result (*run)(const Arguments&, const ProgramEnvironment&)) {
  Command command = MakeCommand(app, arguments, run);
  command.servers = [arguments] { return arguments->server.address; };
  return command;
}

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_COMMAND_H_

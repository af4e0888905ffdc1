#ifndef DUET_CLIENT_CLI_COMMAND_H_
#define DUET_CLIENT_CLI_COMMAND_H_

#include <CLI/CLI.hpp>
#include <functional>
#include <iosfwd>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/client.h"
#include "client/error_details.h"
#include "nlohmann/json_fwd.hpp"

namespace duet::client::cli {

// The result that the program reports to its caller, such as a job scheduler.
enum ExitCode : int {
  kExitDone = 0,
  kExitRetry = 1,      // the same call may succeed later
  kExitUsage = 2,      // the command line is invalid
  kExitBadInput = 42,  // the same call will never succeed: input, model or credentials
};

// The exit code for a call or a file that failed with `status`; IsPermanent says which code.
inline ExitCode ExitCodeFor(const absl::Status& status) {
  if (status.ok()) return kExitDone;
  return IsPermanent(status) ? kExitBadInput : kExitRetry;
}

// The end of --help of the program and of duet synthesize.
inline constexpr char kExitCodesFooter[] = R"(
Exit codes:
  0   done
  1   failed, but the same call may succeed later (server away, busy or draining; a full disk)
  2   the command line or a setting is invalid
  42  failed, and will fail again: the input, the model or the credentials are rejected

Example:
  duet synthesize --leader kick.bvh --label kick=1 --out pair.html --out pair.bvh
)";

// The flag that fixes how a file was read: "Specify it with --frame-rate HZ.\n"; empty if there is
// none.
std::string DescribeAdvice(const absl::Status& status);

// The JSON text that this program prints.
std::string Print(const nlohmann::json& value);

// How the program reaches servers, and where it reads and prints; tests replace it.
struct ProgramEnvironment {
  std::function<absl::StatusOr<Client>(const ClientOptions&)> connect;
  std::ostream* out;
  std::ostream* err;
  int in_descriptor = 0;         // what `-` reads
  bool err_is_terminal = false;  // then progress is updated in place
};

// Runs the whole `duet` program: parses, calls, writes and prints. Returns its exit code.
// `arguments` come without the program's name.
int RunProgram(const std::vector<std::string>& arguments, const ProgramEnvironment& environment);

// A command of the program.
struct Command {
  CLI::App* app = nullptr;  // its name, help and flags
  // Runs after its flags were parsed. The program reports the error, if any.
  std::function<absl::StatusOr<ExitCode>(const ProgramEnvironment&)> run;
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
Command MakeCommand(CLI::App* app, std::shared_ptr<Arguments> arguments,
                    Result (*run)(const Arguments&, const ProgramEnvironment&)) {
  return {app, [arguments = std::move(arguments), run](const ProgramEnvironment& environment) {
            return Done(run(*arguments, environment));
          }};
}

// Each adds a command to the program; its file, such as view_command.cc, has all of it.
Command AddModelsCommand(CLI::App* program);
Command AddSynthesizeCommand(CLI::App* program);
Command AddLiveCommand(CLI::App* program);
Command AddBatchCommand(CLI::App* program);
Command AddInspectCommand(CLI::App* program);
Command AddConvertCommand(CLI::App* program);
Command AddViewCommand(CLI::App* program);
Command AddAdminCommand(CLI::App* program);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_COMMAND_H_

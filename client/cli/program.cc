#include <ostream>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/cli/command.h"
#include "client/error_details.h"
#include "model/base/text.h"
#include "model/motion/reading_setting.h"
#include "nlohmann/json.hpp"

namespace duet::client::cli {
namespace {

// The flag for a setting that a motion file does not state.
std::string FlagFor(motion::ReadingSetting setting) {
  switch (setting) {
    case motion::ReadingSetting::kFormat:
      return "--input-format FORMAT";
    case motion::ReadingSetting::kFrameRate:
      return "--frame-rate HZ";
    case motion::ReadingSetting::kMetresPerUnit:
      return "--metres-per-unit METRES";
    case motion::ReadingSetting::kJointMap:
      return "--joint-map MODEL_JOINT=FILE_JOINT, or a table of them with --joint-map FILE";
    case motion::ReadingSetting::kRigJointMap:
      return "--rig-joint-map MODEL_JOINT=RIG_JOINT, or a table of them with --rig-joint-map FILE";
  }
  return "";
}

std::string Advice(const absl::Status& status) {
  if (std::string advice = DescribeAdvice(status); !advice.empty()) return advice;
  if (ExitCodeFor(status) != kExitRetry) return "";
  // An error reason shows that a Duet server answered.
  if (absl::IsUnavailable(status) && ErrorReason(status).empty()) {
    return "Start a duet-server there, or name another one with --server HOST:PORT (and --tls or "
           "--tls-ca FILE if it encrypts).\n";
  }
  return "Trying again later may help.\n";
}

// The error, with one line for every rejected field, and a hint.
std::string DescribeFailure(const absl::Status& status) {
  const std::string code = absl::StatusCodeToString(status.code());
  const std::vector<FieldViolation> violations = FieldViolations(status);
  if (violations.empty()) {
    return absl::StrCat("duet: ", status.message(), " (", code, ")\n", Advice(status));
  }
  std::string text = absl::StrCat("duet: the server rejects the request (", code, ")\n");
  for (const FieldViolation& violation : violations) {
    absl::StrAppend(&text, "  ", violation.field, violation.field.empty() ? "" : ": ",
                    violation.description, "\n");
  }
  return text + Advice(status);
}

}  // namespace

std::string Print(const nlohmann::json& value) {
  return value.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::string DescribeAdvice(const absl::Status& status) {
  const auto setting = motion::MendingSetting(status);
  return setting.has_value() ? absl::StrCat("Specify it with ", FlagFor(*setting), ".\n") : "";
}

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
    *environment.err << DescribeFailure(code.status());
    return ExitCodeFor(code.status());
  }
  return kExitUsage;  // not reached: a command is required
}

}  // namespace duet::client::cli

#include "client/cli/man_command.h"

#include <filesystem>
#include <memory>
#include <ostream>
#include <string>

#include "client/cli/command_table.h"
#include "client/cli/man_page.h"
#include "model/base/nearest.h"
#include "model/base/text.h"

namespace duet::client::cli {
namespace {

struct ManArguments {
  std::string command;
  std::filesystem::path folder;
};

absl::StatusOr<ExitCode> RunMan(const ManArguments& arguments, const CommandContext& context) {
  if (!arguments.folder.empty()) return Done(WriteManualPages(context.program, arguments.folder));
  const std::string page = ManualPage(context.program, arguments.command);
  if (page.empty()) {
    *context.environment.err << "There is no command " << base::Quoted(arguments.command)
                             << base::DidYouMean(arguments.command, CommandNames(context.program))
                             << "\n";
    return kExitUsage;
  }
  *context.environment.out << page;
  return kExitDone;
}

}  // namespace

Command AddManCommand(FlagSet* program) {
  const auto arguments = std::make_shared<ManArguments>();
  Command command;
  command.app = program->AddCommand("man", "Print a manual page");
  command.app->Add("command", &arguments->command, "Command to explain (default: duet itself)")
      ->Form("COMMAND");
  command.app->Add("--out", &arguments->folder, "Write all pages into this folder instead")
      ->Form("FOLDER");
  command.run = [arguments](const CommandContext& context) { return RunMan(*arguments, context); };
  command.uses_settings = false;
  return command;
}

}  // namespace duet::client::cli

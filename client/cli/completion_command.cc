#include "client/cli/completion_command.h"

#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "client/cli/completion.h"
#include "client/cli/flags.h"

namespace duet::client::cli {

Command AddCompletionCommand(CLI::App* program) {
  const auto shell = std::make_shared<std::string>();
  Command command;
  command.app =
      program->add_subcommand("completion", "Print a script that completes duet in a shell");
  command.app->add_option("shell", *shell, "bash, zsh or fish")
      ->required()
      ->check(Undescribed(CLI::IsMember(std::vector<std::string>{"bash", "zsh", "fish"})))
      ->type_name("bash|zsh|fish");
  command.run = [shell](const CommandContext& context) {
    *context.environment.out << CompletionScript(context.program, *shell);
    return kExitDone;
  };
  command.uses_settings = false;
  return command;
}

}  // namespace duet::client::cli

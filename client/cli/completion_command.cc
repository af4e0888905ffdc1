#include "client/cli/completion_command.h"

#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "client/cli/completion.h"
#include "client/cli/flags.h"

namespace duet::client::cli {

Command AddCompletionCommand(FlagSet* program) {
  const auto shell = std::make_shared<std::string>();
  Command command;
  command.app = program->AddCommand("completion", "Print a script that completes duet in a shell");
  command.app->Add("shell", shell.get(), "bash, zsh or fish")
      ->Required()
      ->OneOf({"bash", "zsh", "fish"})
      ->Form("bash|zsh|fish");
  command.run = [shell](const CommandContext& context) {
    *context.environment.out << CompletionScript(context.program, *shell);
    return kExitDone;
  };
  command.uses_settings = false;
  return command;
}

}  // namespace duet::client::cli

#include "client/cli/commands.h"

#include "client/cli/admin_command.h"
#include "client/cli/batch_command.h"
#include "client/cli/compare_command.h"
#include "client/cli/completion_command.h"
#include "client/cli/convert_command.h"
#include "client/cli/help_command.h"
#include "client/cli/inspect_command.h"
#include "client/cli/live_command.h"
#include "client/cli/man_command.h"
#include "client/cli/models_command.h"
#include "client/cli/stdio_command.h"
#include "client/cli/synthesize_command.h"
#include "client/cli/view_command.h"

namespace duet::client::cli {
namespace {

constexpr Command (*kCommands[])(FlagSet* program) = {
    AddModelsCommand,  AddSynthesizeCommand, AddLiveCommand,    AddBatchCommand, AddInspectCommand,
    AddConvertCommand, AddViewCommand,       AddCompareCommand, AddAdminCommand, AddStdioCommand,
    AddHelpCommand,    AddCompletionCommand, AddManCommand};

}  // namespace

std::vector<Command> AddCommands(FlagSet* program) {
  std::vector<Command> commands;
  for (const auto add : kCommands) commands.push_back(add(program));
  return commands;
}

}  // namespace duet::client::cli

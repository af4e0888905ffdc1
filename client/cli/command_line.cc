#include "client/cli/command_line.h"

#include "client/cli/admin_flags.h"
#include "client/cli/batch_flags.h"
#include "client/cli/flags.h"
#include "client/cli/help_topics.h"
#include "client/cli/motion_flags.h"
#include "client/cli/server_flags.h"
#include "client/cli/synthesize_flags.h"

namespace duet::client::cli {
namespace {

constexpr char kExitCodes[] = R"(
Exit codes:
  0   done
  1   failed, but the same call may succeed later (server away, busy or draining)
  2   the command line makes no sense
  42  failed, and will again: the input, the model or the credentials are refused

Example:
  duet synthesize --leader kick.bvh --label kick=1 --out pair.html --out pair.bvh
)";

void AddModelsCommand(CLI::App* app, ModelsArguments* arguments) {
  CLI::App* command = app->add_subcommand("models", "List the models being served");
  AddServerFlags(command, &arguments->server);
  command->add_flag("--json", arguments->json, "Print JSON");
}

void AddStdioCommand(CLI::App* app) {
  app->add_subcommand("stdio", "Run commands read from standard input, for other programs")
      ->footer(R"(
Each line of standard input is a JSON array with the words of a command. Each is answered with a
line of JSON and as many bytes as it says of the command's standard output and standard error.

Example:
  echo '["convert", "walk.bvh", "--out", "-", "--output-format", "json"]' | duet stdio
)");
}

// What tells of the program itself.
void AddHelpCommands(CommandLine* line) {
  CLI::App* help = line->app.add_subcommand("help", "Explain a command or a topic");
  help->add_option("topic", line->help_topic, "A command, or one of: " + HelpTopicNames())
      ->type_name("TOPIC");
  CLI::App* completion =
      line->app.add_subcommand("completion", "Print what makes a shell complete this program");
  completion->add_option("shell", line->shell, "bash, zsh or fish")
      ->required()
      ->check(Undescribed(CLI::IsMember(std::vector<std::string>{"bash", "zsh", "fish"})))
      ->type_name("bash|zsh|fish");
  CLI::App* man = line->app.add_subcommand("man", "Print a manual page");
  man->add_option("command", line->manual_page, "The command that it is of; duet itself without")
      ->type_name("COMMAND");
  man->add_option("--out", line->man.folder, "Write all pages into this folder instead")
      ->type_name("FOLDER");
}

}  // namespace

CommandLine::CommandLine()
    : app("Asks a Duet server to answer one character's motion with another's.", "duet") {
  app.set_version_flag("--version", "duet " DUET_VERSION);
  app.require_subcommand(1);
  app.footer(kExitCodes);
  app.get_formatter()->column_width(34);
  AddModelsCommand(&app, &models);
  AddSynthesizeCommand(&app, &synthesize)->footer(kExitCodes);
  AddBatchCommand(&app, &batch);
  AddInspectCommand(&app, &inspect);
  AddConvertCommand(&app, &convert);
  AddViewCommand(&app, &view);
  AddCompareCommand(&app, &compare);
  AddAdminCommand(&app, &admin);
  AddStdioCommand(&app);
  AddHelpCommands(this);
}

const CLI::App* FindCommand(const CLI::App& app, const std::string& name) {
  for (const CLI::App* command : app.get_subcommands({})) {
    if (command->get_name() == name) return command;
  }
  return nullptr;
}

std::vector<std::string> CommandNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

}  // namespace duet::client::cli

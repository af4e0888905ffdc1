#include "client/cli/admin_flags.h"

#include "client/cli/server_flags.h"

namespace duet::client::cli {
namespace {

using Action = AdminArguments::Action;

constexpr char kFooter[] = R"(
The server's admin service is off unless its configuration says admin_listen.

Examples:
  duet admin models
  duet admin load sbu 3
  duet admin label sbu canary 3
  duet admin reload
)";

// The server's flags may follow the command as well.
CLI::App* AddAction(CLI::App* app, const char* name, const char* help, Action action,
                    AdminArguments* arguments) {
  CLI::App* command = app->add_subcommand(name, help)->fallthrough();
  command->callback([arguments, action] { arguments->action = action; });
  return command;
}

void AddModel(CLI::App* command, AdminArguments* arguments) {
  command->add_option("name", arguments->name, "The model")->required()->type_name("NAME");
}

CLI::Option* AddVersion(CLI::App* command, AdminArguments* arguments) {
  return command->add_option("version", arguments->version, "Its version")->type_name("VERSION");
}

}  // namespace

void AddAdminCommand(CLI::App* app, AdminArguments* arguments) {
  CLI::App* command = app->add_subcommand("admin", "Tell a running server what to serve");
  command->require_subcommand(1);
  command->footer(kFooter);
  command->add_option("--admin-server", arguments->server.address, "Where its admin service is")
      ->capture_default_str()
      ->type_name("HOST:PORT")
      ->group(kServerGroup);
  AddConnectionFlags(command, &arguments->server);
  command->add_flag("--json", arguments->json, "Print JSON");
  AddAction(command, "models", "List every version and how it stands", Action::kModels, arguments);
  AddAction(command, "reload", "Read configuration and model repository again", Action::kReload,
            arguments);
  CLI::App* load = AddAction(command, "load", "Load a version, again if it is served already",
                             Action::kLoad, arguments);
  AddModel(load, arguments);
  AddVersion(load, arguments)->required();
  CLI::App* unload =
      AddAction(command, "unload", "Serve a version no longer", Action::kUnload, arguments);
  AddModel(unload, arguments);
  AddVersion(unload, arguments)->required();
  CLI::App* label =
      AddAction(command, "label", "Point a version label at a version", Action::kLabel, arguments);
  AddModel(label, arguments);
  label->add_option("label", arguments->label, "The label")->required()->type_name("LABEL");
  CLI::Option* version = AddVersion(label, arguments);
  CLI::Option* remove = label->add_flag("--delete", arguments->delete_label, "Delete it instead");
  remove->excludes(version);
  label->callback([arguments, version, remove] {
    arguments->action = Action::kLabel;
    if (version->empty() && remove->empty()) throw CLI::RequiredError("version or --delete");
  });
}

}  // namespace duet::client::cli

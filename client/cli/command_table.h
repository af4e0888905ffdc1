#ifndef DUET_CLIENT_CLI_COMMAND_TABLE_H_
#define DUET_CLIENT_CLI_COMMAND_TABLE_H_

#include <string>
#include <vector>

#include "client/cli/flag_set.h"

namespace duet::client::cli {

// A flag or an argument without a name, as help shows it.
struct FlagEntry {
  std::string name;  // "--server"; of an argument "files"
  std::string form;  // "HOST:PORT"; empty for a switch
  std::string help;
  std::string group;
  std::string default_value;         // may be empty
  std::vector<std::string> choices;  // of "left|right"; empty where anything goes
  bool takes_file = false;
  bool is_argument = false;
  bool is_required = false;
};

// A command: its full name ("batch merge"; of the program itself empty) and what it takes.
struct CommandEntry {
  std::string name;
  std::string help;
  std::string footer;
  std::vector<FlagEntry> flags;  // then the arguments
  std::vector<std::string> subcommands;
};

// The program, every command, and every command of a command, in the order of help.
std::vector<CommandEntry> ListCommands(const FlagSet& app);

// The command of that name, or null.
const FlagSet* FindCommand(const FlagSet& app, const std::string& name);
std::vector<std::string> CommandNames(const FlagSet& app);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_COMMAND_TABLE_H_

#ifndef DUET_CLIENT_CLI_COMMAND_LINE_H_
#define DUET_CLIENT_CLI_COMMAND_LINE_H_

#include <string>
#include <vector>

#include "client/cli/command.h"
#include "client/cli/flag_set.h"
#include "client/cli/settings.h"

namespace duet::client::cli {

// What a command line asks for: to run `command`, or, if that is null, to print `text` and exit
// with `exit_code` (help, version, a usage error).
struct ParsedCommandLine {
  const Command* command = nullptr;  // owned by the CommandLine
  std::vector<std::string> words;    // the arguments, with the settings that apply
  std::string text;
  int exit_code = kExitDone;
};

// The program's commands and flags: the source of parsing, help, completion and manual pages.
class CommandLine {
 public:
  CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  const FlagSet& app() const { return app_; }

  // Whether settings apply to the command that `arguments` name.
  bool UsesSettings(const std::vector<std::string>& arguments) const;

  // Call at most once. `arguments` come without the program's name; `settings` apply to flags that
  // are not among them. Never connects to a server. The only files it looks at are output folders.
  ParsedCommandLine Parse(const std::vector<std::string>& arguments,
                          const std::vector<Setting>& settings = {});

 private:
  FlagSet app_;
  std::vector<Command> commands_;
};

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_COMMAND_LINE_H_

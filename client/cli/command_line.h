#ifndef DUET_CLIENT_CLI_COMMAND_LINE_H_
#define DUET_CLIENT_CLI_COMMAND_LINE_H_

#include <string>
#include <vector>

#include "CLI/CLI.hpp"
#include "client/cli/arguments.h"

namespace duet::client::cli {

// All commands with their flags: what parsing, help, completion and the manual pages come from.
class CommandLine {
 public:
  CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  CLI::App app;
  ModelsArguments models;
  AdminArguments admin;
  SynthesizeArguments synthesize;
  BatchArguments batch;
  InspectArguments inspect;
  ConvertArguments convert;
  ViewArguments view;
  CompareArguments compare;
  std::string help_topic;
  std::string shell;
  std::string manual_page;
  ManArguments man;
};

// The command of that name, or null.
const CLI::App* FindCommand(const CLI::App& app, const std::string& name);
std::vector<std::string> CommandNames(const CLI::App& app);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_COMMAND_LINE_H_

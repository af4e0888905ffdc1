#include "client/cli/command_line.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/cli/command_table.h"
#include "client/cli/commands.h"
#include "client/cli/exit_code.h"
#include "model/base/nearest.h"
#include "model/base/text.h"

namespace duet::client::cli {
namespace {

using Strings = std::vector<std::string>;

ParsedCommandLine UsageError(const std::string& message) {
  ParsedCommandLine parsed;
  parsed.text = absl::StrCat(message, "\nRun with --help for more information.\n");
  parsed.exit_code = kExitUsage;
  return parsed;
}

ParsedCommandLine Text(std::string text) {
  ParsedCommandLine parsed;
  parsed.text = std::move(text);
  return parsed;
}

// "--server" of "--server" and "--server=lab:50051".
std::string FlagOf(const std::string& argument) { return argument.substr(0, argument.find('=')); }

bool IsGiven(const std::string& flag, const Strings& arguments) {
  for (const std::string& argument : arguments) {
    if (argument == "--") return false;
    if (FlagOf(argument) == flag) return true;
  }
  return false;
}

Strings FlagNames(const FlagSet& command) {
  Strings names;
  for (const std::unique_ptr<Flag>& flag : command.flags()) {
    if (!flag->is_argument()) names.push_back(flag->name());
  }
  return names;
}

// Whether a flag on the command line excludes this one.
bool IsExcluded(const FlagSet& command, const std::string& flag, const Strings& arguments) {
  for (const std::string& name : command.Find(flag)->excluded()) {
    if (IsGiven(name, arguments)) return true;
  }
  return false;
}

// The command line's arguments and, after the command, the settings that apply to it.
class Settled {
 public:
  Settled(const FlagSet& app, const Strings& arguments, const std::vector<Setting>& settings)
      : arguments_(arguments) {
    const auto command =
        std::find_if(arguments.begin(), arguments.end(),
                     [](const std::string& argument) { return !absl::StartsWith(argument, "-"); });
    if (command == arguments.end()) return;
    const FlagSet* chosen = FindCommand(app, *command);
    if (chosen == nullptr) return;
    Strings added;
    for (const Setting& setting : settings) {
      const std::string flag = absl::StrCat("--", setting.name);
      if (!Knows(*chosen, flag)) continue;
      if (IsGiven(flag, arguments) || IsExcluded(*chosen, flag, arguments)) continue;
      chosen->Find(flag)->MarkAsSetting();
      added.push_back(absl::StrCat(flag, "=", setting.value));
      used_.push_back(setting);
    }
    arguments_.insert(arguments_.begin() + (command - arguments.begin()) + 1, added.begin(),
                      added.end());
  }

  const Strings& arguments() const { return arguments_; }

  // The source of the setting that an error is about, as "config:3: "; empty if it is about a flag.
  std::string SourceOf(const std::string& error) const {
    for (const Setting& setting : used_) {
      if (absl::StrContains(error, absl::StrCat("--", setting.name))) {
        return absl::StrCat(setting.source, ": ");
      }
    }
    return "";
  }

 private:
  static bool Knows(const FlagSet& command, const std::string& flag) {
    const Strings names = FlagNames(command);
    return std::find(names.begin(), names.end(), flag) != names.end();
  }

  Strings arguments_;
  std::vector<Setting> used_;
};

// The error about the first setting that no command has a flag for; empty if there is none.
std::string FindUnknownSetting(const FlagSet& app, const std::vector<Setting>& settings) {
  Strings known;
  for (const std::unique_ptr<FlagSet>& command : app.commands()) {
    for (const std::string& flag : FlagNames(*command)) known.push_back(flag.substr(2));
  }
  for (const Setting& setting : settings) {
    if (std::find(known.begin(), known.end(), setting.name) != known.end()) continue;
    return absl::StrCat(setting.source, ": no command has a flag --", setting.name,
                        base::DidYouMean(setting.name, known));
  }
  return "";
}

// The error about a first word that is not a command; empty if it is one.
std::string FindUnknownCommand(const FlagSet& app, const Strings& arguments) {
  if (arguments.empty() || absl::StartsWith(arguments[0], "-")) return "";
  if (FindCommand(app, arguments[0]) != nullptr || IsGiven("--help", arguments)) return "";
  return absl::StrCat("There is no command ", base::Quoted(arguments[0]),
                      base::DidYouMean(arguments[0], CommandNames(app)));
}

// "; did you mean --admin-server?" for --server, of which the known flag is a longer form, or for a
// flag with another spelling.
std::string SuggestedFlag(const std::string& flag, const Strings& known) {
  for (const std::string& name : known) {
    if (absl::EndsWith(name, flag.substr(1))) return absl::StrCat("; did you mean ", name, "?");
  }
  return base::DidYouMean(flag, known);
}

// The error about the first flag that the command does not have; empty if there is none.
std::string FindUnknownFlag(const FlagSet& app, const Strings& arguments) {
  const FlagSet* command = arguments.empty() ? nullptr : FindCommand(app, arguments[0]);
  if (command == nullptr) return "";
  Strings known = FlagNames(*command);
  for (const std::unique_ptr<FlagSet>& subcommand : command->commands()) {
    const Strings further = FlagNames(*subcommand);
    known.insert(known.end(), further.begin(), further.end());
  }
  for (const std::string& argument : arguments) {
    if (argument == "--") break;
    if (!absl::StartsWith(argument, "--")) continue;
    const std::string flag = FlagOf(argument);
    if (std::find(known.begin(), known.end(), flag) != known.end()) continue;
    return absl::StrCat(arguments[0], " has no flag ", flag, SuggestedFlag(flag, known));
  }
  return "";
}

}  // namespace

CommandLine::CommandLine()
    : app_("Asks a Duet server to answer one character's motion with another's.", "duet") {
  app_.Version("duet " DUET_VERSION);
  app_.RequireCommand();
  app_.Footer(kExitCodesFooter);
  commands_ = AddCommands(&app_);
}

bool CommandLine::UsesSettings(const std::vector<std::string>& arguments) const {
  if (arguments.empty() || absl::StartsWith(arguments[0], "-")) return false;
  for (const Command& command : commands_) {
    if (command.app->name() == arguments[0]) return command.uses_settings;
  }
  return true;
}

ParsedCommandLine CommandLine::Parse(const std::vector<std::string>& arguments,
                                     const std::vector<Setting>& settings) {
  for (const std::string& error :
       {FindUnknownSetting(app_, settings), FindUnknownCommand(app_, arguments)}) {
    if (!error.empty()) return UsageError(error);
  }
  const Settled settled(app_, arguments, settings);
  const ParsedFlags flags = app_.Parse(settled.arguments());
  if (flags.outcome == ParsedFlags::Outcome::kAnswer) return Text(flags.text);
  if (flags.outcome == ParsedFlags::Outcome::kError) {
    // An unknown flag may cause other errors: its value counts as one argument more.
    const std::string unknown = FindUnknownFlag(app_, arguments);
    if (!unknown.empty()) return UsageError(unknown);
    ParsedCommandLine parsed = Text(absl::StrCat(settled.SourceOf(flags.error), flags.text));
    parsed.exit_code = kExitUsage;
    return parsed;
  }
  ParsedCommandLine parsed;
  for (const Command& command : commands_) {
    if (command.app->is_given()) parsed.command = &command;
  }
  parsed.words = settled.arguments();
  return parsed;
}

}  // namespace duet::client::cli

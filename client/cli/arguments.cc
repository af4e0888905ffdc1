#include "client/cli/arguments.h"

#include <algorithm>
#include <cstddef>
#include <sstream>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/cli/command_line.h"
#include "client/cli/completion.h"
#include "client/cli/exit_code.h"
#include "client/cli/help_topics.h"
#include "client/cli/man_page.h"
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

Strings FlagNames(const CLI::App& command) {
  Strings names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back(absl::StrCat("--", name));
  }
  return names;
}

// Whether a flag that the command line has rules a setting out.
bool IsExcluded(const CLI::App& command, const std::string& flag, const Strings& arguments) {
  for (const CLI::Option* option : command.get_option(flag)->get_excludes()) {
    for (const std::string& name : option->get_lnames()) {
      if (IsGiven(absl::StrCat("--", name), arguments)) return true;
    }
  }
  return false;
}

// The command line's arguments with the settings that count among them.
class Settled {
 public:
  Settled(const CLI::App& app, const Strings& arguments, const std::vector<Setting>& settings)
      : arguments_(arguments) {
    const auto command =
        std::find_if(arguments.begin(), arguments.end(),
                     [](const std::string& argument) { return !absl::StartsWith(argument, "-"); });
    if (command == arguments.end()) return;
    const CLI::App* chosen = FindCommand(app, *command);
    if (chosen == nullptr) return;
    Strings added;
    for (const Setting& setting : settings) {
      const std::string flag = absl::StrCat("--", setting.name);
      if (!Knows(*chosen, flag)) continue;
      if (IsGiven(flag, arguments) || IsExcluded(*chosen, flag, arguments)) continue;
      added.push_back(absl::StrCat(flag, "=", setting.value));
      used_.push_back(setting);
    }
    arguments_.insert(arguments_.begin() + (command - arguments.begin()) + 1, added.begin(),
                      added.end());
  }

  const Strings& arguments() const { return arguments_; }

  // Where an error about a setting comes from: "config:3: "; empty for those of the command line.
  std::string SourceOf(const std::string& error) const {
    for (const Setting& setting : used_) {
      if (absl::StrContains(error, absl::StrCat("--", setting.name))) {
        return absl::StrCat(setting.source, ": ");
      }
    }
    return "";
  }

 private:
  static bool Knows(const CLI::App& command, const std::string& flag) {
    const Strings names = FlagNames(command);
    return std::find(names.begin(), names.end(), flag) != names.end();
  }

  Strings arguments_;
  std::vector<Setting> used_;
};

// A setting that no command has a flag for; empty where there is none.
std::string FindUnknownSetting(const CLI::App& app, const std::vector<Setting>& settings) {
  Strings known;
  for (const CLI::App* command : app.get_subcommands({})) {
    for (const std::string& flag : FlagNames(*command)) known.push_back(flag.substr(2));
  }
  for (const Setting& setting : settings) {
    if (std::find(known.begin(), known.end(), setting.name) != known.end()) continue;
    return absl::StrCat(setting.source, ": no command has a flag --", setting.name,
                        base::DidYouMean(setting.name, known));
  }
  return "";
}

// A first word that is no command; empty where it is one.
std::string FindUnknownCommand(const CLI::App& app, const Strings& arguments) {
  if (arguments.empty() || absl::StartsWith(arguments[0], "-")) return "";
  if (FindCommand(app, arguments[0]) != nullptr || IsGiven("--help", arguments)) return "";
  return absl::StrCat("There is no command ", base::Quoted(arguments[0]),
                      base::DidYouMean(arguments[0], CommandNames(app)));
}

// The first flag that the command does not have; empty where there is none.
std::string FindUnknownFlag(const CLI::App& app, const Strings& arguments) {
  const CLI::App* command = arguments.empty() ? nullptr : FindCommand(app, arguments[0]);
  if (command == nullptr) return "";
  Strings known = FlagNames(*command);
  for (const CLI::App* subcommand : command->get_subcommands({})) {
    const Strings further = FlagNames(*subcommand);
    known.insert(known.end(), further.begin(), further.end());
  }
  for (const std::string& argument : arguments) {
    if (argument == "--") break;
    if (!absl::StartsWith(argument, "--")) continue;
    const std::string flag = FlagOf(argument);
    if (std::find(known.begin(), known.end(), flag) != known.end()) continue;
    return absl::StrCat(arguments[0], " has no flag ", flag, base::DidYouMean(flag, known));
  }
  return "";
}

ParsedCommandLine Collect(CommandLine* line) {
  const auto is_parsed = [line](const char* name) {
    return line->app.get_subcommand(name)->parsed();
  };
  if (is_parsed("help")) return ExplainTopic(line->app, line->help_topic);
  if (is_parsed("completion")) return Text(CompletionScript(line->app, line->shell));
  ParsedCommandLine parsed;
  if (is_parsed("man")) {
    if (line->man.folder.empty()) return PrintManualPage(line->app, line->manual_page);
    parsed.man = std::move(line->man);
  }
  parsed.stdio = is_parsed("stdio");
  if (is_parsed("models")) parsed.models = std::move(line->models);
  if (is_parsed("admin")) parsed.admin = std::move(line->admin);
  if (is_parsed("synthesize")) parsed.synthesize = std::move(line->synthesize);
  if (is_parsed("batch")) parsed.batch = std::move(line->batch);
  if (is_parsed("inspect")) parsed.inspect = std::move(line->inspect);
  if (is_parsed("convert")) parsed.convert = std::move(line->convert);
  if (is_parsed("view")) parsed.view = std::move(line->view);
  if (is_parsed("compare")) parsed.compare = std::move(line->compare);
  return parsed;
}

}  // namespace

std::vector<std::filesystem::path> SampleOutputs(const SynthesizeArguments& arguments, int sample) {
  std::vector<std::filesystem::path> outputs = arguments.outputs;
  if (arguments.samples == 1) return outputs;
  for (std::filesystem::path& output : outputs) {
    if (!output.has_extension()) continue;  // is refused under the name that it came with
    output.replace_filename(absl::StrCat(output.stem().string(), ".seed", SeedOf(arguments, sample),
                                         output.extension().string()));
  }
  return outputs;
}

ParsedCommandLine ParseCommandLine(const std::vector<std::string>& arguments,
                                   const std::vector<Setting>& settings) {
  CommandLine line;
  for (const std::string& error :
       {FindUnknownSetting(line.app, settings), FindUnknownCommand(line.app, arguments)}) {
    if (!error.empty()) return UsageError(error);
  }
  const Settled settled(line.app, arguments, settings);
  try {
    // CLI11 takes the arguments in reverse.
    line.app.parse(Strings(settled.arguments().rbegin(), settled.arguments().rend()));
  } catch (const CLI::ParseError& error) {
    std::ostringstream out;
    const int code = line.app.exit(error, out, out);
    if (code == 0) return Text(out.str());
    // What else is wrong may follow from it: the flag's value counts as one argument more.
    const std::string unknown = FindUnknownFlag(line.app, arguments);
    if (!unknown.empty()) return UsageError(unknown);
    ParsedCommandLine parsed;
    parsed.text = absl::StrCat(settled.SourceOf(error.what()), out.str());
    parsed.exit_code = kExitUsage;
    return parsed;
  }
  ParsedCommandLine parsed = Collect(&line);
  if (parsed.batch.has_value()) parsed.batch->words = settled.arguments();
  return parsed;
}

}  // namespace duet::client::cli

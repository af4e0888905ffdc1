#include "client/cli/completion.h"

#include <cstddef>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/str_split.h"
#include "client/cli/command_table.h"
#include "client/cli/help_topics.h"

namespace duet::client::cli {
namespace {

using Strings = std::vector<std::string>;

// In all scripts, @PROGRAM@ is the program's name and @FUNCTION@ is the name of the shell function
// that completes it.

// Words that are valid in place of a flag.
Strings WordsOf(const CommandEntry& command, const std::vector<CommandEntry>& all) {
  Strings words = command.subcommands;
  for (const FlagEntry& flag : command.flags) {
    if (flag.is_argument) words.insert(words.end(), flag.choices.begin(), flag.choices.end());
  }
  if (command.name == "help" || command.name == "man") {
    words.insert(words.end(), all[0].subcommands.begin(), all[0].subcommands.end());
  }
  if (command.name == "help") {
    for (const std::string& topic : HelpTopics()) words.push_back(topic);
  }
  return words;
}

bool TakesFiles(const CommandEntry& command) {
  for (const FlagEntry& flag : command.flags) {
    if (flag.is_argument && flag.takes_file) return true;
  }
  return command.name == "batch";  // its leaders are files, folders and patterns
}

Strings FlagNames(const CommandEntry& command) {
  Strings names;
  for (const FlagEntry& flag : command.flags) {
    if (!flag.is_argument) names.push_back(flag.name);
  }
  return names;
}

std::string BashCase(const CommandEntry& command, const std::vector<CommandEntry>& all) {
  std::string text = absl::StrCat("    '", command.name, "')\n      case \"$before\" in\n");
  for (const FlagEntry& flag : command.flags) {
    if (flag.is_argument || flag.form.empty()) continue;
    absl::StrAppend(
        &text, "        ", flag.name, ") ", flag.takes_file ? "files=1" : "",
        flag.takes_file ? "" : absl::StrCat("words='", absl::StrJoin(flag.choices, " "), "'"),
        "; flags='' ;;\n");
  }
  absl::StrAppend(&text, "        *) words='", absl::StrJoin(WordsOf(command, all), " "),
                  "'; flags='", absl::StrJoin(FlagNames(command), " "), "'",
                  TakesFiles(command) ? "; files=1" : "", " ;;\n      esac ;;\n");
  return text;
}

// The command before the cursor, such as "batch merge".
constexpr char kBashHead[] =
    R"(# bash completion for @PROGRAM@: source it, or install it as completions/@PROGRAM@.
@FUNCTION@() {
  local word="${COMP_WORDS[COMP_CWORD]}" before="${COMP_WORDS[COMP_CWORD-1]}"
  # bash takes the '=' of --flag=value for a word of its own.
  if [[ $word == '=' ]]; then word=''; fi
  if [[ $before == '=' ]]; then before="${COMP_WORDS[COMP_CWORD-2]}"; fi
  local command='' words='' flags='' files='' i
  for ((i = 1; i < COMP_CWORD; i++)); do
    case "$command ${COMP_WORDS[i]}" in
@COMMANDS@    esac
  done
  case "$command" in
)";
constexpr char kBashTail[] = R"(  esac
  COMPREPLY=()
  if [[ $word == -* ]]; then
    COMPREPLY=($(compgen -W "$flags" -- "$word"))
    return
  fi
  COMPREPLY=($(compgen -W "$words" -- "$word"))
  if [[ -n $files ]]; then
    compopt -o filenames 2>/dev/null
    local IFS=$'\n'
    COMPREPLY+=($(compgen -f -- "$word"))
  fi
}
complete -F @FUNCTION@ @PROGRAM@
)";

// The pattern of a command with its parent: " batch", "batch merge".
std::string StepOf(const std::string& name) {
  return name.find(' ') == std::string::npos ? absl::StrCat(" ", name) : name;
}

std::string BashScript(const std::vector<CommandEntry>& commands) {
  std::string steps;
  for (const CommandEntry& command : commands) {
    if (command.name.empty()) continue;
    absl::StrAppend(&steps, "      '", StepOf(command.name), "') command='", command.name,
                    "' ;;\n");
  }
  std::string text = absl::StrReplaceAll(kBashHead, {{"@COMMANDS@", steps}});
  for (const CommandEntry& command : commands) absl::StrAppend(&text, BashCase(command, commands));
  return text + kBashTail;
}

// Text inside single quotes, for bash and zsh, and for fish if it has no backslash.
std::string Quoted(const std::string& text) {
  return absl::StrCat("'", absl::StrReplaceAll(text, {{"'", "'\\''"}}), "'");
}

// Escapes a description for the square brackets of _arguments.
std::string ZshText(const std::string& text) {
  return absl::StrReplaceAll(text, {{"\\", "\\\\"}, {"[", "\\["}, {"]", "\\]"}, {":", "\\:"}});
}

std::string ZshAction(const FlagEntry& flag) {
  if (!flag.choices.empty()) return absl::StrCat("(", absl::StrJoin(flag.choices, " "), ")");
  return flag.takes_file ? "_files" : " ";
}

std::string ZshFunction(const std::string& name) {
  return absl::StrCat("@FUNCTION@", name.empty() ? "" : "_",
                      absl::StrReplaceAll(name, {{" ", "_"}}));
}

std::string ZshCommand(const CommandEntry& command, const std::vector<CommandEntry>& all) {
  std::string text = absl::StrCat(ZshFunction(command.name), "() {\n");
  if (!command.subcommands.empty()) {
    absl::StrAppend(&text, "  local state line\n  local -a commands=(\n");
    for (const CommandEntry& other : all) {
      for (const std::string& subcommand : command.subcommands) {
        const std::string full =
            absl::StrCat(command.name, command.name.empty() ? "" : " ", subcommand);
        if (other.name != full) continue;
        absl::StrAppend(&text, "    ", Quoted(absl::StrCat(subcommand, ":", ZshText(other.help))),
                        "\n");
      }
    }
    text += "  )\n";
  }
  absl::StrAppend(&text, "  _arguments", command.subcommands.empty() ? "" : " -C");
  for (const FlagEntry& flag : command.flags) {
    if (flag.is_argument) continue;
    const std::string spec = absl::StrCat(
        "*", flag.name, flag.form.empty() ? "" : "=", "[", ZshText(flag.help), "]",
        flag.form.empty() ? "" : absl::StrCat(":", ZshText(flag.form), ":", ZshAction(flag)));
    absl::StrAppend(&text, " \\\n    ", Quoted(spec));
  }
  if (!command.subcommands.empty()) {
    absl::StrAppend(&text, " \\\n    '1: :->command' \\\n    '*:: :->rest'\n");
    absl::StrAppend(&text, "  case $state in\n    command) _describe command commands",
                    TakesFiles(command) ? "; _files" : "",
                    " ;;\n    rest)\n      case $words[1] in\n");
    for (const std::string& subcommand : command.subcommands) {
      const std::string full =
          absl::StrCat(command.name, command.name.empty() ? "" : " ", subcommand);
      absl::StrAppend(&text, "        ", subcommand, ") ", ZshFunction(full), " ;;\n");
    }
    absl::StrAppend(&text, TakesFiles(command) ? "        *) _files ;;\n" : "",
                    "      esac ;;\n  esac\n}\n");
    return text;
  }
  const Strings words = WordsOf(command, all);
  if (!words.empty()) {
    absl::StrAppend(&text, " \\\n    ",
                    Quoted(absl::StrCat("*:word:(", absl::StrJoin(words, " "), ")")));
  } else if (TakesFiles(command)) {
    absl::StrAppend(&text, " \\\n    '*:file:_files'");
  }
  return text + "\n}\n";
}

std::string ZshScript(const std::vector<CommandEntry>& commands) {
  std::string text =
      "#compdef @PROGRAM@\n# zsh completion for @PROGRAM@: install it as _@PROGRAM@ in a folder of "
      "$fpath.\n";
  for (const CommandEntry& command : commands)
    absl::StrAppend(&text, ZshCommand(command, commands));
  return text +
         "if [ \"$funcstack[1]\" = _@PROGRAM@ ]; then @FUNCTION@ \"$@\"; "
         "else compdef @FUNCTION@ @PROGRAM@; fi\n";
}

// fish escapes a quote inside single quotes with a backslash.
std::string FishQuoted(const std::string& text) {
  return absl::StrCat("'", absl::StrReplaceAll(text, {{"\\", "\\\\"}, {"'", "\\'"}}), "'");
}

// Whether the words before the cursor name this command and none of its subcommands.
std::string FishCondition(const CommandEntry& command) {
  if (command.name.empty()) return "__fish_use_subcommand";
  const Strings words = absl::StrSplit(command.name, ' ');
  std::string condition = "set -l words (commandline -opc)";
  for (std::size_t i = 0; i < words.size(); ++i) {
    absl::StrAppend(&condition, i == 0 ? "; " : "; and ", "test \"$words[", i + 2,
                    "]\" = ", words[i]);
  }
  if (!command.subcommands.empty()) {
    absl::StrAppend(&condition, "; and not __fish_seen_subcommand_from ",
                    absl::StrJoin(command.subcommands, " "));
  }
  return condition;
}

std::string FishCommand(const CommandEntry& command, const std::vector<CommandEntry>& all) {
  const std::string start =
      absl::StrCat("complete -c @PROGRAM@ -n ", FishQuoted(FishCondition(command)));
  std::string text;
  for (const FlagEntry& flag : command.flags) {
    if (flag.is_argument) continue;
    absl::StrAppend(&text, start, " -l ", flag.name.substr(2));
    if (!flag.form.empty()) absl::StrAppend(&text, flag.takes_file ? " -r -F" : " -x");
    if (!flag.choices.empty()) {
      absl::StrAppend(&text, " -a ", FishQuoted(absl::StrJoin(flag.choices, " ")));
    }
    absl::StrAppend(&text, " -d ", FishQuoted(flag.help), "\n");
  }
  for (const std::string& word : WordsOf(command, all)) {
    absl::StrAppend(&text, start, " -a ", FishQuoted(word), "\n");
  }
  if (TakesFiles(command)) absl::StrAppend(&text, start, " -F\n");
  return text;
}

std::string FishScript(const std::vector<CommandEntry>& commands) {
  std::string text =
      "# fish completion for @PROGRAM@: install it as completions/@PROGRAM@.fish.\n"
      "complete -c @PROGRAM@ -f\n";
  for (const CommandEntry& command : commands)
    absl::StrAppend(&text, FishCommand(command, commands));
  return text;
}

}  // namespace

std::string CompletionScript(const FlagSet& app, const std::string& shell) {
  const std::vector<CommandEntry> commands = ListCommands(app);
  const std::string script = shell == "zsh"    ? ZshScript(commands)
                             : shell == "fish" ? FishScript(commands)
                                               : BashScript(commands);
  const std::string function = absl::StrCat("_", absl::StrReplaceAll(app.name(), {{"-", "_"}}));
  return absl::StrReplaceAll(script, {{"@PROGRAM@", app.name()}, {"@FUNCTION@", function}});
}

}  // namespace duet::client::cli

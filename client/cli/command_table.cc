#include "client/cli/command_table.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"

namespace duet::client::cli {
namespace {

// Whether a value's form lists all allowed values: lower-case words separated by bars.
std::vector<std::string> ChoicesOf(const std::string& form) {
  const auto is_plain = [](char c) {
    const auto letter = static_cast<unsigned char>(c);
    return absl::ascii_islower(letter) || absl::ascii_isdigit(letter) || c == '-' || c == '|';
  };
  if (!absl::StrContains(form, "|") || !std::all_of(form.begin(), form.end(), is_plain)) return {};
  return absl::StrSplit(form, '|');
}

FlagEntry EntryOf(const Flag& flag) {
  FlagEntry entry;
  entry.is_argument = flag.is_argument();
  entry.name = flag.name();
  entry.form = flag.form();
  entry.help = flag.help();
  entry.group = flag.group();
  entry.default_value = flag.default_value();
  entry.choices = ChoicesOf(entry.form);
  entry.takes_file =
      absl::StrContains(entry.form, "FILE") && !absl::StrContains(entry.form, "FILE_");
  entry.takes_file |= absl::StrContains(entry.form, "FOLDER");
  entry.is_required = flag.is_required();
  return entry;
}

void Append(const FlagSet& app, const std::string& name, std::vector<CommandEntry>* entries) {
  CommandEntry entry;
  entry.name = name;
  entry.help = app.description();
  entry.footer = app.footer();
  for (const bool arguments : {false, true}) {
    for (const std::unique_ptr<Flag>& flag : app.flags()) {
      if (flag->is_argument() == arguments) entry.flags.push_back(EntryOf(*flag));
    }
  }
  entry.subcommands = CommandNames(app);
  entries->push_back(std::move(entry));
  for (const std::unique_ptr<FlagSet>& command : app.commands()) {
    Append(*command, absl::StrCat(name, name.empty() ? "" : " ", command->name()), entries);
  }
}

}  // namespace

std::vector<CommandEntry> ListCommands(const FlagSet& app) {
  std::vector<CommandEntry> entries;
  Append(app, "", &entries);
  return entries;
}

const FlagSet* FindCommand(const FlagSet& app, const std::string& name) {
  for (const std::unique_ptr<FlagSet>& command : app.commands()) {
    if (command->name() == name) return command.get();
  }
  return nullptr;
}

std::vector<std::string> CommandNames(const FlagSet& app) {
  std::vector<std::string> names;
  for (const std::unique_ptr<FlagSet>& command : app.commands()) names.push_back(command->name());
  return names;
}

}  // namespace duet::client::cli

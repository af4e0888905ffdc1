#include "client/cli/command_table.h"

#include <algorithm>
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

FlagEntry EntryOf(const CLI::Option& option) {
  FlagEntry entry;
  entry.is_argument = option.get_positional();
  entry.name =
      entry.is_argument ? option.get_name(true) : absl::StrCat("--", option.get_lnames()[0]);
  entry.form = option.get_items_expected_max() == 0 ? "" : option.get_type_name();
  entry.help = option.get_description();
  entry.group = option.get_group();
  entry.default_value = option.get_default_str();
  entry.choices = ChoicesOf(entry.form);
  entry.takes_file =
      absl::StrContains(entry.form, "FILE") && !absl::StrContains(entry.form, "FILE_");
  entry.takes_file |= absl::StrContains(entry.form, "FOLDER");
  entry.is_required = option.get_required();
  return entry;
}

void Append(const CLI::App& app, const std::string& name, std::vector<CommandEntry>* entries) {
  CommandEntry entry;
  entry.name = name;
  entry.help = app.get_description();
  entry.footer = app.get_footer();
  for (const bool arguments : {false, true}) {
    for (const CLI::Option* option : app.get_options()) {
      if (option->get_positional() == arguments) entry.flags.push_back(EntryOf(*option));
    }
  }
  const std::vector<const CLI::App*> subcommands = app.get_subcommands({});
  for (const CLI::App* command : subcommands) entry.subcommands.push_back(command->get_name());
  entries->push_back(std::move(entry));
  for (const CLI::App* command : subcommands) {
    Append(*command, absl::StrCat(name, name.empty() ? "" : " ", command->get_name()), entries);
  }
}

}  // namespace

std::vector<CommandEntry> ListCommands(const CLI::App& app) {
  std::vector<CommandEntry> entries;
  Append(app, "", &entries);
  return entries;
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

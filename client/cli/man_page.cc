#include "client/cli/man_page.h"

#include <system_error>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"
#include "client/cli/command_table.h"
#include "client/cli/help_topics.h"
#include "model/base/file.h"

namespace duet::client::cli {
namespace {

// Escapes text: no markup, and hyphens that can be copied.
std::string Escaped(absl::string_view text) {
  std::string escaped =
      absl::StrReplaceAll(text, {{"\\", "\\e"}, {"-", "\\-"}, {"'", "\\(aq"}, {"\u00b0", "\\(de"}});
  if (absl::StartsWith(escaped, ".")) escaped.insert(0, "\\&");
  return escaped;
}

// Lines without filling.
std::string Example(absl::string_view text) {
  std::string page = ".nf\n";
  for (absl::string_view line : absl::StrSplit(absl::StripSuffix(text, "\n"), '\n')) {
    absl::StrAppend(&page, line.empty() ? ".sp" : Escaped(line), "\n");
  }
  return page + ".fi\n";
}

std::string FullName(const FlagSet& app, const CommandEntry& command) {
  return absl::StrCat(app.name(), command.name.empty() ? "" : " ", command.name);
}

std::string PageName(const FlagSet& app, const CommandEntry& command) {
  return absl::StrReplaceAll(FullName(app, command), {{" ", "-"}});
}

std::string Synopsis(const FlagSet& app, const CommandEntry& command) {
  std::string text = absl::StrCat(".B ", Escaped(FullName(app, command)), "\n");
  if (!command.subcommands.empty()) {
    absl::StrAppend(&text, command.name.empty() ? ".I COMMAND\n" : ".RI [ COMMAND ]\n");
  }
  for (const FlagEntry& flag : command.flags) {
    if (flag.is_argument || !flag.is_required) continue;
    absl::StrAppend(&text, ".B ", Escaped(flag.name), "\n.I ", Escaped(flag.form), "\n");
  }
  absl::StrAppend(&text, ".RI [ OPTIONS ]\n");
  for (const FlagEntry& flag : command.flags) {
    if (!flag.is_argument) continue;
    const std::string form = Escaped(flag.form);
    absl::StrAppend(
        &text, flag.is_required ? absl::StrCat(".I ", form) : absl::StrCat("[\\fI", form, "\\fR]"),
        "\n");
  }
  return text;
}

std::string Options(const CommandEntry& command) {
  std::string text, group;
  for (const FlagEntry& flag : command.flags) {
    const std::string heading = flag.is_argument          ? "Arguments"
                                : flag.group == "Options" ? "General"
                                                          : flag.group;
    if (heading != group) absl::StrAppend(&text, ".SS ", Escaped(heading), "\n");
    group = heading;
    absl::StrAppend(&text, ".TP\n");
    if (flag.is_argument) {
      absl::StrAppend(&text, ".I ", Escaped(flag.form), "\n");
    } else {
      absl::StrAppend(&text, "\\fB", Escaped(flag.name), "\\fR",
                      flag.form.empty() ? "" : absl::StrCat(" \\fI", Escaped(flag.form), "\\fR"),
                      "\n");
    }
    std::string help(absl::StripSuffix(flag.help, "."));
    if (flag.is_required) help += " (required)";
    if (!flag.default_value.empty()) absl::StrAppend(&help, " (default: ", flag.default_value, ")");
    absl::StrAppend(&text, Escaped(help), ".\n");
  }
  return text;
}

std::string Commands(const FlagSet& app, const CommandEntry& command,
                     const std::vector<CommandEntry>& all) {
  std::string text;
  for (const std::string& name : command.subcommands) {
    const std::string full = absl::StrCat(command.name, command.name.empty() ? "" : " ", name);
    for (const CommandEntry& other : all) {
      if (other.name != full) continue;
      absl::StrAppend(&text, ".TP\n\\fB", Escaped(PageName(app, other)), "\\fR(1)\n",
                      Escaped(other.help), ".\n");
    }
  }
  return text;
}

// The topics of duet help, one section each.
std::string Topics() {
  std::string text;
  for (const std::string& topic : HelpTopics()) {
    const std::string explained = TopicText(topic);
    const std::size_t end = explained.find('\n');
    absl::StrAppend(&text, ".SH ",
                    absl::AsciiStrToUpper(Escaped(absl::StripAsciiWhitespace(topic))), "\n",
                    Escaped(absl::StripAsciiWhitespace(explained.substr(0, end))), "\n.PP\n",
                    Example(absl::StripAsciiWhitespace(explained.substr(end))));
  }
  return text;
}

std::string Page(const FlagSet& app, const CommandEntry& command,
                 const std::vector<CommandEntry>& all) {
  const bool program = command.name.empty();
  std::string help(absl::StripSuffix(command.help, "."));
  std::string text = absl::StrCat(".TH ", absl::AsciiStrToUpper(Escaped(PageName(app, command))),
                                  " 1 \"\" \"duet ", DUET_VERSION, "\" \"User Commands\"\n");
  absl::StrAppend(&text, ".SH NAME\n", Escaped(PageName(app, command)), " \\- ", Escaped(help),
                  "\n");
  absl::StrAppend(&text, ".SH SYNOPSIS\n", Synopsis(app, command));
  absl::StrAppend(&text, ".SH DESCRIPTION\n", Escaped(help), ".\n");
  if (!command.subcommands.empty()) {
    absl::StrAppend(&text, ".SH COMMANDS\n", Commands(app, command, all));
  }
  absl::StrAppend(&text, ".SH OPTIONS\n", Options(command));
  const absl::string_view footer = absl::StripAsciiWhitespace(command.footer);
  if (!footer.empty()) absl::StrAppend(&text, ".SH NOTES\n", Example(footer));
  const bool explains = FindCommand(app, "help") != nullptr;
  if (program && explains) absl::StrAppend(&text, Topics());
  absl::StrAppend(&text, ".SH SEE ALSO\n");
  if (program && explains) {
    absl::StrAppend(&text, ".BR duet\\-load (1),\n.BR duet\\-server (8)\n");
  } else {
    absl::StrAppend(&text, ".BR duet (1)\n");
  }
  return text;
}

}  // namespace

std::string ManualPage(const FlagSet& app, const std::string& command) {
  const std::vector<CommandEntry> all = ListCommands(app);
  for (const CommandEntry& entry : all) {
    if (entry.name == command) return Page(app, entry, all);
  }
  return "";
}

absl::Status WriteManualPages(const FlagSet& app, const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  const std::vector<CommandEntry> all = ListCommands(app);
  for (const CommandEntry& command : all) {
    const absl::Status status = base::WriteFile(folder / absl::StrCat(PageName(app, command), ".1"),
                                                Page(app, command, all));
    if (!status.ok()) return status;
  }
  return absl::OkStatus();
}

}  // namespace duet::client::cli

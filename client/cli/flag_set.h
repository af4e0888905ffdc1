#ifndef DUET_CLIENT_CLI_FLAG_SET_H_
#define DUET_CLIENT_CLI_FLAG_SET_H_

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

// The flags of a program and its commands. Only flag_set.cc includes CLI11, which parses them: its
// header takes two seconds to compile, in each file that includes it.

namespace CLI {  // NOLINT(readability-identifier-naming): CLI11 has this name.
class App;
class Option;
}  // namespace CLI

namespace duet::client::cli {

// A flag ("--server"), or an argument without a name ("leaders"). Methods return the flag itself.
// Owned by its FlagSet.
class Flag {
 public:
  explicit Flag(CLI::Option* option) : option_(option) {}
  Flag(const Flag&) = delete;
  Flag& operator=(const Flag&) = delete;

  // Help shows the value as `form`, such as HOST:PORT, and the flag below the heading `group`.
  Flag* Form(const std::string& form);
  Flag* Group(const std::string& group);
  // Help shows the default: the current value of the target, or `text`.
  Flag* ShowDefault();
  Flag* ShowDefault(const std::string& text);
  Flag* Required();
  // A repeated flag collects values, and each takes one, so that a file name that follows is never
  // read as another value.
  Flag* OneValueEach();
  // Of a repeated flag, only the last one counts.
  Flag* LastOnly();
  // One flag may hold several values, separated by `delimiter`.
  Flag* SplitAt(char delimiter);
  // The number of values.
  Flag* Count(int least, int most);
  // This flag requires or excludes another one of the same set.
  Flag* Needs(Flag* other);
  Flag* Excludes(Flag* other);
  // The environment variable that sets the flag if it is not given.
  Flag* Environment(const std::string& variable);

  // What a value must be.
  Flag* InRange(int least, int most);
  Flag* InRange(std::int64_t least, std::int64_t most);
  Flag* InRange(double least, double most);
  Flag* AboveZero();  // a finite number
  Flag* OneOf(const std::vector<std::string>& choices);
  Flag* ExistingFile();

  // A value comes from the command line, or from the configuration file.
  bool is_given() const;
  // The same, but not from the configuration file, whose flags only apply where they fit.
  bool is_typed() const { return is_given() && !is_setting_; }
  void MarkAsSetting() { is_setting_ = true; }
  std::vector<std::string> values() const;

  bool is_argument() const;
  bool is_required() const;
  // The name on the command line: "--server"; of an argument "leaders".
  std::string name() const;
  std::string form() const;  // empty for a switch
  std::string help() const;
  std::string group() const;
  std::string default_value() const;          // may be empty
  std::vector<std::string> excluded() const;  // the names of flags that this one excludes

 private:
  CLI::Option* option_;
  bool is_setting_ = false;
};

// The result of parsing a command line.
struct ParsedFlags {
  enum class Outcome { kDone, kAnswer, kError };
  Outcome outcome = Outcome::kDone;
  std::string text;   // to print: the answer to --help or --version, or a usage error
  std::string error;  // the message in that text
};

// A program or one of its commands, with its flags. Owned by the program's set.
class FlagSet {
 public:
  // A program. Its help describes it and begins its columns of explanations at the 34th character.
  FlagSet(const std::string& help, const std::string& name);
  FlagSet() : FlagSet("", "") {}
  FlagSet(const FlagSet&) = delete;
  FlagSet& operator=(const FlagSet&) = delete;

  FlagSet* AddCommand(const std::string& name, const std::string& help);
  // The text below the flags in help.
  void Footer(const std::string& text);
  // "--version" prints `text`.
  void Version(const std::string& text);
  // A command line must name one of the commands.
  void RequireCommand();
  // Flags of the parent are valid after this command.
  void InheritFlags();
  // Calls `check` after the flags were parsed. It may call RejectFlag or RejectMissing.
  void Check(std::function<void()> check);

  // Adds a flag or, without leading dashes, an argument, whose value is written to `target`.
  // flag_set.cc lists the types. `target` outlives the set.
  template <typename T>
  Flag* Add(const std::string& name, T* target, const std::string& help);
  // A flag without a value.
  Flag* AddSwitch(const std::string& name, bool* target, const std::string& help);
  // Calls `read` with the value, or with all values of a repeated flag. It may call RejectFlag.
  Flag* AddReader(const std::string& name, std::function<void(const std::string&)> read,
                  const std::string& help);
  Flag* AddListReader(const std::string& name,
                      std::function<void(const std::vector<std::string>&)> read,
                      const std::string& help);

  const std::string& name() const;
  std::string description() const;
  std::string footer() const;
  // In the order of help.
  const std::vector<std::unique_ptr<FlagSet>>& commands() const { return commands_; }
  // The flags, with --help, in the order of help.
  const std::vector<std::unique_ptr<Flag>>& flags() const { return flags_; }
  // The flag of that name, or null.
  Flag* Find(const std::string& name) const;

  // The text of --help. `parent` names the program before a command.
  std::string Help(const std::string& parent = "") const;

  // Call at most once, on the program's set. `arguments` come without the program's name.
  ParsedFlags Parse(const std::vector<std::string>& arguments);
  // Whether the command line named this command, or one of its commands.
  bool is_given() const;
  bool names_command() const;

 private:
  explicit FlagSet(CLI::App* command);
  Flag* Keep(CLI::Option* option);

  std::shared_ptr<CLI::App> owned_;  // of a program
  CLI::App* app_;
  std::vector<std::unique_ptr<Flag>> flags_;
  std::vector<std::unique_ptr<FlagSet>> commands_;
};

// For use during parsing: a usage error about a flag, "--out: expected ...", or about one that is
// missing.
[[noreturn]] void RejectFlag(const std::string& flag, const std::string& message);
[[noreturn]] void RejectMissing(const std::string& what);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_FLAG_SET_H_

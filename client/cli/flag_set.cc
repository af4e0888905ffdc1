#include "client/cli/flag_set.h"

#include <optional>
#include <sstream>
#include <utility>

#include "CLI/CLI.hpp"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/base/program_flags.h"
#include "model/base/text.h"
#include "model/base/usage_text.h"

namespace duet::client::cli {
namespace {

// `validator` with the error "expected <what>, got <value>", and without a description in --help.
CLI::Validator Expects(const std::string& what, const CLI::Validator& validator) {
  const auto check = [what, validator](const std::string& text) {
    if (validator(text).empty()) return std::string();
    return absl::StrCat("expected ", what, ", got ", base::Quoted(text));
  };
  return CLI::Validator(check, "");
}

// "bash, zsh or fish"
std::string Choices(const std::vector<std::string>& choices) {
  const std::string last = absl::StrCat(choices.size() > 1 ? " or " : "", choices.back());
  return absl::StrCat(absl::StrJoin(choices.begin(), choices.end() - 1, ", "), last);
}

template <typename Number>
CLI::Validator ExpectsRange(const std::string& what, Number least, Number most,
                            const CLI::Validator& range) {
  return Expects(absl::StrCat(what, " from ", least, " to ", most), range);
}

// CLI11's own validator prints the largest double in --help.
std::string CheckAboveZero(const std::string& text) {
  double value = 0;
  if (base::ParseNumber(text, &value) && value > 0) return "";
  return absl::StrCat("expected a number above 0, got ", base::Quoted(text));
}

}  // namespace

Flag* Flag::Form(const std::string& form) {
  option_->type_name(form);
  return this;
}

Flag* Flag::Group(const std::string& group) {
  option_->group(group);
  return this;
}

Flag* Flag::ShowDefault() {
  option_->capture_default_str();
  return this;
}

Flag* Flag::ShowDefault(const std::string& text) {
  option_->default_str(text);
  return this;
}

Flag* Flag::Required() {
  option_->required();
  return this;
}

Flag* Flag::OneValueEach() {
  option_->allow_extra_args(false);
  return this;
}

Flag* Flag::LastOnly() {
  option_->take_last();
  return this;
}

Flag* Flag::SplitAt(char delimiter) {
  option_->delimiter(delimiter);
  return this;
}

Flag* Flag::Count(int least, int most) {
  option_->expected(least, most);
  return this;
}

Flag* Flag::Needs(Flag* other) {
  option_->needs(other->option_);
  return this;
}

Flag* Flag::Excludes(Flag* other) {
  option_->excludes(other->option_);
  return this;
}

Flag* Flag::Environment(const std::string& variable) {
  option_->envname(variable);
  return this;
}

Flag* Flag::InRange(int least, int most) {
  option_->check(ExpectsRange("a whole number", least, most, base::InRange(least, most)));
  return this;
}

Flag* Flag::InRange(std::int64_t least, std::int64_t most) {
  option_->check(ExpectsRange("a whole number", least, most, CLI::Range(least, most)));
  return this;
}

Flag* Flag::InRange(double least, double most) {
  option_->check(ExpectsRange("a number", least, most, base::InRange(least, most)));
  return this;
}

Flag* Flag::AboveZero() {
  option_->check(CLI::Validator(CheckAboveZero, ""));
  return this;
}

Flag* Flag::OneOf(const std::vector<std::string>& choices) {
  option_->check(Expects(Choices(choices), CLI::IsMember(choices)));
  return this;
}

Flag* Flag::ExistingFile() {
  option_->check(Expects("a file that exists", CLI::ExistingFile));
  return this;
}

bool Flag::is_given() const { return option_->count() > 0; }

std::vector<std::string> Flag::values() const { return option_->results(); }

bool Flag::is_argument() const { return option_->get_positional(); }

bool Flag::is_required() const { return option_->get_required(); }

std::string Flag::name() const {
  return is_argument() ? option_->get_name(true) : absl::StrCat("--", option_->get_lnames()[0]);
}

std::string Flag::form() const {
  return option_->get_items_expected_max() == 0 ? "" : option_->get_type_name();
}

std::string Flag::help() const { return option_->get_description(); }

std::string Flag::group() const { return option_->get_group(); }

std::string Flag::default_value() const { return option_->get_default_str(); }

std::vector<std::string> Flag::excluded() const {
  std::vector<std::string> names;
  for (CLI::Option* other : option_->get_excludes()) names.push_back(Flag(other).name());
  return names;
}

FlagSet::FlagSet(const std::string& help, const std::string& name)
    : owned_(std::make_shared<CLI::App>(help, name)), app_(owned_.get()) {
  app_->get_formatter()->column_width(34);
  Keep(app_->get_help_ptr());
}

FlagSet::FlagSet(CLI::App* command) : app_(command) { Keep(app_->get_help_ptr()); }

Flag* FlagSet::Keep(CLI::Option* option) {
  flags_.push_back(std::make_unique<Flag>(option));
  return flags_.back().get();
}

FlagSet* FlagSet::AddCommand(const std::string& name, const std::string& help) {
  commands_.push_back(std::unique_ptr<FlagSet>(new FlagSet(app_->add_subcommand(name, help))));
  return commands_.back().get();
}

void FlagSet::Footer(const std::string& text) { app_->footer(text); }

void FlagSet::Version(const std::string& text) { Keep(app_->set_version_flag("--version", text)); }

void FlagSet::RequireCommand() { app_->require_subcommand(1); }

void FlagSet::InheritFlags() { app_->fallthrough(); }

void FlagSet::Check(std::function<void()> check) { app_->callback(std::move(check)); }

template <typename T>
Flag* FlagSet::Add(const std::string& name, T* target, const std::string& help) {
  return Keep(app_->add_option(name, *target, help));
}

// Each type that a flag's value has.
using Path = std::filesystem::path;
template Flag* FlagSet::Add(const std::string&, int*, const std::string&);
template Flag* FlagSet::Add(const std::string&, std::int64_t*, const std::string&);
template Flag* FlagSet::Add(const std::string&, std::uint32_t*, const std::string&);
template Flag* FlagSet::Add(const std::string&, double*, const std::string&);
template Flag* FlagSet::Add(const std::string&, std::string*, const std::string&);
template Flag* FlagSet::Add(const std::string&, Path*, const std::string&);
template Flag* FlagSet::Add(const std::string&, std::optional<int>*, const std::string&);
template Flag* FlagSet::Add(const std::string&, std::optional<double>*, const std::string&);
template Flag* FlagSet::Add(const std::string&, std::optional<std::string>*, const std::string&);
template Flag* FlagSet::Add(const std::string&, std::vector<int>*, const std::string&);
template Flag* FlagSet::Add(const std::string&, std::vector<double>*, const std::string&);
template Flag* FlagSet::Add(const std::string&, std::vector<std::string>*, const std::string&);
template Flag* FlagSet::Add(const std::string&, std::vector<Path>*, const std::string&);

Flag* FlagSet::AddSwitch(const std::string& name, bool* target, const std::string& help) {
  return Keep(app_->add_flag(name, *target, help));
}

Flag* FlagSet::AddReader(const std::string& name, std::function<void(const std::string&)> read,
                         const std::string& help) {
  return Keep(app_->add_option_function<std::string>(name, read, help));
}

Flag* FlagSet::AddListReader(const std::string& name,
                             std::function<void(const std::vector<std::string>&)> read,
                             const std::string& help) {
  return Keep(app_->add_option_function<std::vector<std::string>>(name, read, help));
}

const std::string& FlagSet::name() const { return app_->get_name(); }

std::string FlagSet::description() const { return app_->get_description(); }

std::string FlagSet::footer() const { return app_->get_footer(); }

Flag* FlagSet::Find(const std::string& name) const {
  for (const std::unique_ptr<Flag>& flag : flags_) {
    if (flag->name() == name) return flag.get();
  }
  return nullptr;
}

std::string FlagSet::Help(const std::string& parent) const {
  // App::help of a program would print the help of the command that was parsed.
  if (!parent.empty()) return app_->help(parent);
  return app_->get_formatter()->make_help(app_, app_->get_name(), CLI::AppFormatMode::Normal);
}

ParsedFlags FlagSet::Parse(const std::vector<std::string>& arguments) {
  ParsedFlags parsed;
  try {
    // CLI11 takes the arguments in reverse.
    app_->parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::Success& answer) {
    std::ostringstream out;
    app_->exit(answer, out, out);
    parsed.outcome = ParsedFlags::Outcome::kAnswer;
    parsed.text = out.str();
  } catch (const CLI::ParseError& error) {
    parsed.outcome = ParsedFlags::Outcome::kError;
    parsed.error = base::UsageText(error.what());
    parsed.text = absl::StrCat(parsed.error, "\nRun with --help for more information.\n");
  }
  return parsed;
}

bool FlagSet::is_given() const { return app_->parsed(); }

bool FlagSet::names_command() const { return !app_->get_subcommands().empty(); }

void RejectFlag(const std::string& flag, const std::string& message) {
  throw CLI::ValidationError(flag, message);
}

void RejectMissing(const std::string& what) { throw CLI::RequiredError(what); }

}  // namespace duet::client::cli

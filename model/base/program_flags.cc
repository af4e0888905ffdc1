#include "model/base/program_flags.h"

#include <iostream>
#include <string>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "model/base/text.h"
#include "model/base/usage_text.h"

namespace duet::base {
namespace {

constexpr int kWrongUse = 2;

// The option of that name among those of the program and of the command that was given; may be
// null.
const CLI::Option* FindOption(const CLI::App& app, const std::string& flag) {
  if (const CLI::Option* option = app.get_option_no_throw(flag); option != nullptr) return option;
  for (const CLI::App* command : app.get_subcommands()) {
    if (const CLI::Option* option = FindOption(*command, flag); option != nullptr) return option;
  }
  return nullptr;
}

std::string NumberOf(const std::string& type) {
  if (absl::StartsWith(type, "UINT")) return "a whole number of 0 or more";
  return absl::StartsWith(type, "INT") ? "a whole number" : "a number";
}

// "Could not convert: --seed = x".
std::string ConversionText(const CLI::App& app, const std::string& message) {
  const std::string text = UsageText(message);
  const std::string flag = text.substr(0, text.find(':'));
  const CLI::Option* option = FindOption(app, flag);
  if (option == nullptr || option->get_items_expected_max() == 0) return text;
  const size_t got = text.rfind(", got ");
  return got == std::string::npos
             ? text
             : absl::StrCat(flag, ": expected ", NumberOf(option->get_type_name()),
                            text.substr(got));
}

std::string Explain(const CLI::App& app, const CLI::ParseError& error) {
  if (dynamic_cast<const CLI::ConversionError*>(&error) != nullptr) {
    return ConversionText(app, error.what());
  }
  const std::vector<std::string> extra = app.remaining();
  if (app.get_subcommands().empty() && !extra.empty()) {  // in place of a command
    return absl::StrCat("Unexpected argument ", Quoted(extra.front()));
  }
  return UsageText(error.what());
}

}  // namespace

std::optional<int> ParseFlags(int argc, const char* const* argv, CLI::App* app, std::ostream* out,
                              std::ostream* err) {
  try {
    app->parse(argc, argv);
    return std::nullopt;
  } catch (const CLI::Success& answer) {
    return app->exit(answer, *out, *err);
  } catch (const CLI::ParseError& error) {
    *err << Explain(*app, error) << "\nRun with --help for more information.\n";
  }
  return kWrongUse;
}

std::optional<int> ParseFlags(int argc, const char* const* argv, CLI::App* app) {
  return ParseFlags(argc, argv, app, &std::cout, &std::cerr);
}

CLI::Validator InRange(int least, int most) { return CLI::Range(least, most); }

CLI::Validator InRange(double least, double most) {
  const auto check = [least, most](const std::string& text) {
    double value = 0;
    if (ParseNumber(text, &value) && value >= least && value <= most) return std::string();
    std::string error = "expected ";
    AppendNumber(&error, least);
    error += " to ";
    AppendNumber(&error, most);
    return absl::StrCat(error, ", got ", Quoted(text));
  };
  const CLI::Validator range = CLI::Range(least, most);
  return CLI::Validator(check, range.get_description());
}

}  // namespace duet::base

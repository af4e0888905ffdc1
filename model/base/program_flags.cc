#include "model/base/program_flags.h"

#include <iostream>
#include <string>

#include "absl/strings/str_cat.h"
#include "model/base/text.h"

namespace duet::base {
std::optional<int> ParseFlags(int argc, const char* const* argv, CLI::App* app, std::ostream* out,
                              std::ostream* err) {
  try {
    app->parse(argc, argv);
    return std::nullopt;
  } catch (const CLI::Success& answer) {
    return app->exit(answer, *out, *err);
  } catch (const CLI::ParseError& error) {
    *err << error.what() << "\nRun with --help for more information.\n";
  }
  return 2;
}

std::optional<int> ParseFlags(int argc, const char* const* argv, CLI::App* app) {
  return ParseFlags(argc, argv, app, &std::cout, &std::cerr);
}

namespace {

// `form` describes the range in --help.
CLI::Validator Between(double least, double most, const std::string& form) {
  const auto check = [least, most](const std::string& text) {
    double value = 0;
    if (ParseNumber(text, &value) && value >= least && value <= most) return std::string();
    return absl::StrCat("expected ", NumberText(least), " to ", NumberText(most), ", got ",
                        Quoted(text));
  };
  return CLI::Validator(check, form);
}

}  // namespace

CLI::Validator InRange(int least, int most) {
  return Between(least, most, CLI::Range(least, most).get_description());
}

CLI::Validator InRange(double least, double most) {
  return Between(least, most, CLI::Range(least, most).get_description());
}

}  // namespace duet::base

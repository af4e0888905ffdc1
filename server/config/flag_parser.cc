#include "server/config/flag_parser.h"

#include <google/protobuf/message.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdint>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/str_split.h"
#include "absl/strings/string_view.h"
#include "absl/strings/strip.h"
#include "duet/v1/server_config.pb.h"
#include "model/base/nearest.h"
#include "model/base/text.h"
#include "server/config/environment.h"
#include "server/config/setting.h"

namespace duet::server::config {
namespace {

absl::Status Unexpected(absl::string_view expected, absl::string_view got) {
  return absl::InvalidArgumentError(
      absl::StrCat("expected ", expected, ", got ", base::Quoted(got)));
}

absl::StatusOr<v1::VersionLabel> ParseVersionLabel(const std::string& text) {
  const std::vector<std::string> model = absl::StrSplit(text, absl::MaxSplits(':', 1));
  const std::vector<std::string> label = absl::StrSplit(model.back(), absl::MaxSplits('=', 1));
  v1::VersionLabel parsed;
  uint32_t version = 0;
  if (model.size() != 2 || label.size() != 2 || !absl::SimpleAtoi(label[1], &version)) {
    return Unexpected("model:label=version, such as duet:stable=3", text);
  }
  parsed.set_model(model[0]);
  parsed.set_label(label[0]);
  parsed.set_version(version);
  return parsed;
}

absl::StatusOr<v1::VersionPolicy> ParseVersionPolicy(const std::string& text) {
  const absl::Status malformed =
      Unexpected("model=all, model=latest:2 or model=1,3, where the model * is every other", text);
  const std::vector<std::string> parts = absl::StrSplit(text, absl::MaxSplits('=', 1));
  if (parts.size() != 2) return malformed;
  v1::VersionPolicy policy;
  policy.set_model(parts[0]);
  absl::string_view versions = parts[1];
  if (versions == "all") return policy;
  uint32_t number = 0;
  if (absl::ConsumePrefix(&versions, "latest:")) {
    if (!absl::SimpleAtoi(versions, &number)) return malformed;
    policy.set_latest(number);
    return policy;
  }
  for (const absl::string_view version : absl::StrSplit(versions, ',')) {
    if (!absl::SimpleAtoi(version, &number)) return malformed;
    policy.add_versions(number);
  }
  return policy;
}

// Adds a value of a repeated setting, spelled as on the command line: "model:label=version" for a
// VersionLabel; "model=all", "model=latest:2" or "model=1,3" for a VersionPolicy.
// Fails with INVALID_ARGUMENT "expected ..., got ...".
absl::Status AddValue(const Setting& setting, const std::string& text, v1::ServerConfig* config) {
  if (setting.field().number() == v1::ServerConfig::kVersionLabelsFieldNumber) {
    absl::StatusOr<v1::VersionLabel> label = ParseVersionLabel(text);
    if (label.ok()) *config->add_version_labels() = *std::move(label);
    return label.status();
  }
  absl::StatusOr<v1::VersionPolicy> policy = ParseVersionPolicy(text);
  if (policy.ok()) *config->add_version_policies() = *std::move(policy);
  return policy.status();
}

using v1::ServerConfig;

// How generated code sets a field of a type.
template <typename Value>
using Setter = void (google::protobuf::Reflection::*)(google::protobuf::Message*,
                                                      const Setting::Field*, Value) const;

template <typename Value>
CLI::Option* AddValueFlag(CLI::App& app, const Setting& setting, Setter<Value> setter,
                          ServerConfig* config) {
  return app.add_option_function<Value>(
      "--" + setting.flag(),
      [setting, setter, config](const Value& value) {
        (config->GetReflection()->*setter)(config, &setting.field(), value);
      },
      setting.help());
}

// Returns the mistake in a switch's value, or "". CLI11 2.4 takes a value that it cannot read for
// false.
std::string CheckSwitch(const std::string& value) {
  static constexpr std::array<absl::string_view, 14> kWords = {
      "true", "t", "yes", "y", "on", "enable", "+", "false", "f", "no", "n", "off", "disable", "-"};
  const std::string word = absl::AsciiStrToLower(value);
  std::int64_t number = 0;
  if (std::find(kWords.begin(), kWords.end(), word) != kWords.end()) return "";
  if (absl::SimpleAtoi(value, &number)) return "";
  return absl::StrCat("expected true or false, got ", base::Quoted(value));
}

// "--reflection" and "--no-reflection".
void AddSwitch(CLI::App& app, const Setting& setting, ServerConfig* config) {
  app.add_flag_function(
         absl::StrCat("--", setting.flag(), ",!--no-", setting.flag()),
         [setting, config](std::int64_t count) {
           config->GetReflection()->SetBool(config, &setting.field(), count > 0);
         },
         setting.help())
      ->check(CheckSwitch);
}

void SetChoice(const Setting& setting, const std::string& value, ServerConfig* config) {
  std::vector<std::string> expected;
  for (const Choice& choice : ChoicesOf(*setting.field().enum_type())) {
    if (choice.flag_value == value) {
      config->GetReflection()->SetEnumValue(config, &setting.field(), choice.number);
      return;
    }
    expected.push_back(choice.flag_value);
  }
  throw CLI::ValidationError("--" + setting.flag(), absl::StrCat("expected ", OneOf(expected),
                                                                 ", got ", base::Quoted(value)));
}

CLI::Option* AddChoiceFlag(CLI::App& app, const Setting& setting, ServerConfig* config) {
  return app.add_option_function<std::string>(
      "--" + setting.flag(),
      [setting, config](const std::string& value) { SetChoice(setting, value, config); },
      setting.help());
}

CLI::Option* AddRepeatedFlag(CLI::App& app, const Setting& setting, ServerConfig* config) {
  return app.add_option_function<std::vector<std::string>>(
      "--" + setting.flag(),
      [setting, config](const std::vector<std::string>& values) {
        for (const std::string& value : values) {
          const absl::Status added = AddValue(setting, value, config);
          if (added.ok()) continue;
          throw CLI::ValidationError("--" + setting.flag(), std::string(added.message()));
        }
      },
      setting.help());
}

void AddFlag(CLI::App& app, const Setting& setting, ServerConfig* config) {
  using google::protobuf::Reflection;
  CLI::Option* option = nullptr;
  if (setting.field().is_repeated()) {
    option = AddRepeatedFlag(app, setting, config);
  } else {
    switch (setting.field().cpp_type()) {
      case Setting::Field::CPPTYPE_BOOL:
        AddSwitch(app, setting, config);
        return;
      case Setting::Field::CPPTYPE_ENUM:
        option = AddChoiceFlag(app, setting, config);
        break;
      case Setting::Field::CPPTYPE_UINT32:
        option = AddValueFlag<uint32_t>(app, setting, &Reflection::SetUInt32, config);
        break;
      case Setting::Field::CPPTYPE_UINT64:
        option = AddValueFlag<uint64_t>(app, setting, &Reflection::SetUInt64, config);
        break;
      case Setting::Field::CPPTYPE_DOUBLE:
        option = AddValueFlag<double>(app, setting, &Reflection::SetDouble, config);
        break;
      default:
        option = AddValueFlag<std::string>(app, setting, &Reflection::SetString, config);
    }
  }
  option->option_text(setting.unit());
}

constexpr char kFooter[] = R"(
Every flag that has a value may be an environment variable instead: DUET_SERVER_MAX_CALLS=64 for
--max-calls 64. Flags override variables, variables override the file.

Signals: SIGTERM and SIGINT drain and stop, a second one at once. SIGHUP reads labels, policies,
the model repository, certificates and the access file again.
)";

void AddFlags(CLI::App& app, Flags& flags) {
  app.set_version_flag("--version", std::string("duet-server ") + DUET_VERSION);
  app.footer(kFooter);
  app.add_option("--config", flags.config_path,
                 "Configuration file: duet.v1.ServerConfig in text format, or in JSON if its name "
                 "ends in .json; flags override it")
      ->option_text("FILE");
  app.add_flag_callback(
      "--check-config", [&flags] { flags.task = Task::kCheckConfig; },
      "Check settings and secrets, load every model, report every mistake, and exit");
  app.add_flag_callback(
      "--print-config", [&flags] { flags.task = Task::kPrintConfig; },
      "Print every setting and its source, and exit");
  app.add_flag_callback(
      "--check-health", [&flags] { flags.task = Task::kCheckHealth; },
      "Ask the server that runs here with these settings whether it is healthy, and exit");
  for (const Setting& setting : AllSettings()) AddFlag(app, setting, &flags.config);
}

// Flags that request a single action are not settings.
bool IsSetting(const std::string& flag) {
  return flag != "--help" && flag != "--version" && flag != "--check-config" &&
         flag != "--print-config" && flag != "--check-health";
}

// "expected ..., got ..." for the value of a flag.
std::string Mistake(const CLI::App& app, const std::string& flag, const std::string& value,
                    const CLI::ParseError& error) {
  const CLI::Option* option = app.get_option_no_throw(flag);
  if (option != nullptr && dynamic_cast<const CLI::ConversionError*>(&error) != nullptr) {
    const std::string type = option->get_type_name();
    return absl::StrCat("expected ",
                        type == "UINT"    ? "a whole number of 0 or more"
                        : type == "FLOAT" ? "a number"
                                          : "true or false",
                        ", got ", base::Quoted(value));
  }
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr) {
    return "expected a value, got none";
  }
  absl::string_view text = error.what();
  absl::ConsumePrefix(&text, absl::StrCat(flag, ": "));
  return std::string(text);
}

// CLI::App::parse. CLI11 lets the error of std::stoll escape if a switch has a value that is
// neither true, false nor a number.
template <typename... Words>
void ParseWords(CLI::App& app, Words&&... words) {
  try {
    app.parse(std::forward<Words>(words)...);
  } catch (const std::logic_error& error) {
    throw CLI::ConversionError(error.what());
  }
}

// Describes the words that CLI11 left over. An unknown flag's value may be among them, so the error
// names the flag.
absl::Status NotAFlag(const CLI::App& app, const std::vector<std::string>& words) {
  std::vector<std::string> known;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& flag : option->get_lnames()) known.push_back("--" + flag);
  }
  for (const std::string& word : words) {
    if (!absl::StartsWith(word, "-")) continue;
    const std::string flag = word.substr(0, word.find('='));
    return absl::InvalidArgumentError(
        absl::StrCat(flag, ": there is no such flag", base::DidYouMean(flag, known)));
  }
  return absl::InvalidArgumentError(
      absl::StrCat("expected flags only, got ", base::Quoted(words[0])));
}

absl::Status UnknownVariable(const CLI::App& app, const std::string& name) {
  std::vector<std::string> known;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& flag : option->get_lnames()) {
      if (!IsSetting(absl::StrCat("--", flag))) continue;
      known.push_back(VariableOfFlag(flag));
    }
  }
  return absl::InvalidArgumentError(
      absl::StrCat(name, ": sets nothing", base::DidYouMean(name, known)));
}

}  // namespace

FlagParser::FlagParser()
    : app_(std::make_unique<CLI::App>("Answers one character's motion with another's, over gRPC.",
                                      "duet-server")) {
  AddFlags(*app_, flags_);
}

FlagParser::~FlagParser() = default;

absl::StatusOr<Flags> FlagParser::Parse(int argc, const char* const* argv,
                                        std::optional<std::string>* print) {
  try {
    ParseWords(*app_, argc, argv);
  } catch (const CLI::Success& wanted) {
    std::ostringstream text;
    app_->exit(wanted, text, text);
    // CLI11 marks the negative name of a switch.
    *print = absl::StrReplaceAll(text.str(), {{"{false}", ""}});
  } catch (const CLI::ExtrasError&) {
    return NotAFlag(*app_, app_->remaining());
  } catch (const CLI::ArgumentMismatch& error) {
    const std::vector<std::string> parts = absl::StrSplit(error.what(), absl::MaxSplits(':', 1));
    return absl::InvalidArgumentError(
        absl::StrCat(parts[0], ": expected the flag at most once, got it again"));
  } catch (const CLI::ParseError& error) {
    return absl::InvalidArgumentError(error.what());
  }
  return flags_;
}

absl::StatusOr<Flags> FlagParser::ParseOne(std::vector<std::string> words) {
  const std::vector<std::string> parts = absl::StrSplit(words[0], absl::MaxSplits('=', 1));
  const std::string value = parts.size() > 1 ? parts[1] : words.back();
  std::reverse(words.begin(), words.end());  // the order that CLI11 takes
  try {
    ParseWords(*app_, std::move(words));
  } catch (const CLI::Success&) {
  } catch (const CLI::ExtrasError&) {
    return NotAFlag(*app_, app_->remaining());
  } catch (const CLI::ParseError& error) {
    return absl::InvalidArgumentError(
        absl::StrCat(parts[0], ": ", Mistake(*app_, parts[0], value, error)));
  }
  return flags_;
}

absl::StatusOr<Flags> FlagParser::ParseVariable(const std::string& name, const std::string& value) {
  const std::string flag = FlagOfVariable(name);
  const CLI::Option* option = app_->get_option_no_throw(flag);
  if (option == nullptr || !IsSetting(flag)) return UnknownVariable(*app_, name);
  std::vector<std::string> values = {value};
  if (option->get_expected_max() > 1) values = absl::StrSplit(value, ' ', absl::SkipEmpty());
  // CLI11 takes the words in reverse order. Flag and value form one word, so that a value may begin
  // with a hyphen; CLI11 takes an empty value only as a word of its own.
  std::vector<std::string> words;
  for (const std::string& each : values) {
    if (each.empty()) words.insert(words.end(), {each, flag});
    if (!each.empty()) words.push_back(absl::StrCat(flag, "=", each));
  }
  try {
    ParseWords(*app_, std::move(words));
  } catch (const CLI::ParseError& error) {
    return absl::InvalidArgumentError(absl::StrCat(name, ": ", Mistake(*app_, flag, value, error)));
  }
  return flags_;
}

}  // namespace duet::server::config

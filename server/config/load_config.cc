#include "server/config/load_config.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>
#include <google/protobuf/text_format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstddef>
#include <exception>
#include <sstream>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/str_split.h"
#include "absl/strings/string_view.h"
#include "model/base/file.h"

namespace duet::server::config {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Reflection;

constexpr std::size_t kMaxConfigBytes = std::size_t{1} << 20;
constexpr char kConfigVariable[] = "DUET_SERVER_CONFIG";

constexpr char kFooter[] = R"(
Every flag that has a value may be an environment variable instead: DUET_SERVER_MAX_CALLS=64 for
--max-calls 64. Flags override variables, variables override the file.

Signals: SIGTERM and SIGINT drain and stop, a second one at once. SIGHUP reads labels, the model
repository, certificates and the access file again.
)";

// Merges settings over those of `command_line`. `source` returns the source of a field, given its
// name within `settings`.
template <typename Source>
void Override(const v1::ServerConfig& settings, const Source& source, CommandLine* command_line) {
  const Reflection& reflection = *settings.GetReflection();
  std::vector<const FieldDescriptor*> fields;
  reflection.ListFields(settings, &fields);
  for (const FieldDescriptor* field : fields) {
    if (!field->is_repeated()) {
      command_line->sources[field->name()] = source(field->name());
      continue;
    }
    const int before = reflection.FieldSize(command_line->config, field);
    for (int i = 0; i < reflection.FieldSize(settings, field); ++i) {
      command_line->sources[absl::StrCat(field->name(), "[", before + i, "]")] =
          source(absl::StrCat(field->name(), "[", i, "]"));
    }
  }
  command_line->config.MergeFrom(settings);
}

void AddErrors(const absl::Status& status, CommandLine* command_line) {
  for (absl::string_view line : absl::StrSplit(status.message(), '\n', absl::SkipEmpty())) {
    command_line->errors.emplace_back(line);
  }
}

// Sets a field to values that a flag or a variable has. Mistakes begin with `name`.
void SetValues(const Setting& setting, const std::vector<std::string>& values,
               const std::string& name, const std::string& source, CommandLine* command_line) {
  v1::ServerConfig config;
  for (const std::string& value : values) {
    const absl::Status set = setting.Set(value, &config);
    if (!set.ok())
      AddErrors(absl::Status(set.code(), absl::StrCat(name, ": ", set.message())), command_line);
  }
  Override(
      config, [&source](const std::string&) { return source; }, command_line);
}

void ReadFile(const std::string& path, CommandLine* command_line) {
  v1::ServerConfig config;
  messages::FieldPlaces places;
  AddErrors(ReadConfigFile(path, &config, &places), command_line);
  const auto source = [&](const std::string& field) {
    const auto place = places.find(field);  // JSON has none
    if (place == places.end()) return absl::StrCat("file ", path);
    return absl::StrCat("file ", path, ":", place->second.line, ":", place->second.column);
  };
  Override(config, source, command_line);
}

void ReadVariables(const Environment& environment, CommandLine* command_line) {
  const std::vector<Setting> settings = AllSettings();
  for (const auto& [name, value] : environment) {
    const auto setting =
        std::find_if(settings.begin(), settings.end(),
                     [&name = name](const Setting& one) { return one.variable() == name; });
    if (setting == settings.end()) {
      if (name != kConfigVariable) command_line->errors.push_back(name + ": sets nothing");
      continue;
    }
    std::vector<std::string> values = {value};
    if (setting->field().is_repeated()) values = absl::StrSplit(value, ' ', absl::SkipEmpty());
    SetValues(*setting, values, name, absl::StrCat("environment ", name), command_line);
  }
}

bool IsSwitch(const Setting& setting) {
  return setting.field().cpp_type() == Setting::Field::CPPTYPE_BOOL;
}

// All values are texts for CLI11; Setting::Set reads them, as it does those of variables.
void AddFlags(CLI::App& app) {
  app.set_version_flag("--version", std::string("duet-server ") + DUET_VERSION);
  app.footer(kFooter);
  const std::string config =
      "Configuration file: duet.v1.ServerConfig in text format, or in JSON if its name ends in "
      ".json; flags override it";
  app.add_option("--config", config)->option_text("FILE");
  // CLI11 takes a help only by a constant reference.
  const std::pair<const char*, const std::string> tasks[] = {
      {"--check-config",
       "Check settings and secrets, load every model, report every mistake, and exit"},
      {"--print-config", "Print every setting and its source, and exit"},
      {"--check-health",
       "Ask the server that runs here with these settings whether it is healthy, and exit"}};
  for (const auto& [flag, help] : tasks) app.add_flag(flag, help);
  for (const Setting& setting : AllSettings()) {
    const std::string flag = "--" + setting.flag();
    const std::string help = setting.help();
    if (IsSwitch(setting)) {
      app.add_flag(absl::StrCat(flag, ",!--no-", setting.flag()), help);
      continue;
    }
    CLI::Option* option = app.add_option(flag, help)->option_text(setting.unit());
    if (setting.field().is_repeated()) {
      option->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    }
  }
}

// Parses the command line; `print` receives the text of --help or --version.
absl::Status ParseFlags(CLI::App& app, int argc, const char* const* argv,
                        std::optional<std::string>* print) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& wanted) {
    std::ostringstream text;
    app.exit(wanted, text, text);
    // CLI11 marks the negative name of a switch.
    *print = absl::StrReplaceAll(text.str(), {{"{false}", ""}});
  } catch (const std::exception& error) {
    return absl::InvalidArgumentError(error.what());
  }
  return absl::OkStatus();
}

Task TaskOf(const CLI::App& app) {
  if (app.count("--check-config") > 0) return Task::kCheckConfig;
  if (app.count("--print-config") > 0) return Task::kPrintConfig;
  return app.count("--check-health") > 0 ? Task::kCheckHealth : Task::kServe;
}

std::string PrefixLines(absl::string_view prefix, absl::string_view lines) {
  return absl::StrCat(prefix, absl::StrReplaceAll(lines, {{"\n", absl::StrCat("\n", prefix)}}));
}

// An empty text counts as absent.
bool IsAbsent(const v1::ServerConfig& settings, const FieldDescriptor& field) {
  const Reflection& reflection = *settings.GetReflection();
  if (field.is_repeated()) return reflection.FieldSize(settings, &field) == 0;
  return !reflection.HasField(settings, &field) ||
         (field.cpp_type() == FieldDescriptor::CPPTYPE_STRING &&
          reflection.GetString(settings, &field).empty());
}

}  // namespace

absl::Status ReadConfigFile(const std::filesystem::path& path, v1::ServerConfig* config,
                            messages::FieldPlaces* places) {
  config->Clear();
  const absl::StatusOr<std::string> text = base::ReadFile(path, kMaxConfigBytes, "a configuration");
  if (!text.ok()) {
    return absl::Status(text.status().code(), absl::StrCat("--config: ", text.status().message()));
  }
  const messages::MessageSyntax syntax = path.extension() == ".json"
                                             ? messages::MessageSyntax::kJson
                                             : messages::MessageSyntax::kTextFormat;
  const absl::Status status = messages::ParseMessage(*text, syntax, config, places);
  if (status.ok()) return status;
  return absl::InvalidArgumentError(
      PrefixLines(absl::StrCat("--config: ", path.string(), ": "), status.message()));
}

Environment ReadEnvironment(const char* const* variables) {
  Environment environment;
  for (; *variables != nullptr; ++variables) {
    const std::pair<std::string, std::string> variable =
        absl::StrSplit(*variables, absl::MaxSplits('=', 1));
    const absl::string_view name = variable.first;
    if (!absl::StartsWith(name, kVariablePrefix)) continue;
    const absl::string_view setting = name.substr(kVariablePrefix.size());
    // No setting has such a name.
    const bool is_service_link = setting == "SERVICE_HOST" ||
                                 absl::StartsWith(setting, "SERVICE_PORT") || setting == "PORT" ||
                                 absl::StartsWith(setting, "PORT_");
    if (!is_service_link) environment.insert(variable);
  }
  return environment;
}

CommandLine ParseCommandLine(int argc, const char* const* argv, const Environment& environment) {
  CommandLine command_line;
  CLI::App app("Answers one character's motion with another's, over gRPC.", "duet-server");
  AddFlags(app);
  const absl::Status parsed = ParseFlags(app, argc, argv, &command_line.print);
  if (command_line.print.has_value()) return command_line;
  AddErrors(parsed, &command_line);
  command_line.task = TaskOf(app);
  const auto variable = environment.find(kConfigVariable);
  std::string file = variable == environment.end() ? "" : variable->second;
  if (app.count("--config") > 0) file = app["--config"]->results().back();
  if (!file.empty()) ReadFile(file, &command_line);
  ReadVariables(environment, &command_line);
  for (const Setting& setting : AllSettings()) {
    const std::string flag = "--" + setting.flag();
    std::vector<std::string> values = app[flag]->results();
    if (!setting.field().is_repeated() && values.size() > 1)
      values.erase(values.begin(), values.end() - 1);
    SetValues(setting, values, flag, "command line", &command_line);
  }
  return command_line;
}

Settings ReadSettings(const CommandLine& command_line, int cores, std::uint64_t memory_bytes) {
  Settings settings = ReadSettings(command_line.config, cores, command_line.sources, memory_bytes);
  settings.mistakes.insert(settings.mistakes.begin(), command_line.errors.begin(),
                           command_line.errors.end());
  return settings;
}

absl::StatusOr<v1::ServerConfig> ResolveSettings(const CommandLine& command_line, int cores,
                                                 std::uint64_t memory_bytes) {
  Settings settings = ReadSettings(command_line, cores, memory_bytes);
  if (settings.mistakes.empty()) return std::move(settings.values);
  return absl::InvalidArgumentError(absl::StrJoin(settings.mistakes, "\n"));
}

std::string PrintConfig(const v1::ServerConfig& settings, const SettingSources& sources) {
  google::protobuf::TextFormat::Printer printer;
  printer.SetSingleLineMode(true);
  std::string text;
  const auto print = [&](const FieldDescriptor& field, int index, const std::string& name) {
    std::string value;
    printer.PrintFieldValueToString(settings, &field, index, &value);
    const bool is_message = field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE;
    const auto source = sources.find(name);
    absl::StrAppend(&text, field.name(), is_message ? " { " : ": ", value, is_message ? "}" : "",
                    "  # ", source == sources.end() ? "default" : source->second, "\n");
  };
  for (const Setting& setting : AllSettings()) {
    const FieldDescriptor& field = setting.field();
    if (IsAbsent(settings, field)) {
      absl::StrAppend(&text, "# ", field.name(), " is not set\n");
    } else if (!field.is_repeated()) {
      print(field, -1, field.name());
    } else {
      for (int i = 0; i < settings.GetReflection()->FieldSize(settings, &field); ++i) {
        print(field, i, absl::StrCat(field.name(), "[", i, "]"));
      }
    }
  }
  return text;
}

}  // namespace duet::server::config

#include "server/config/load_config.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/str_split.h"
#include "absl/strings/string_view.h"
#include "model/base/file.h"
#include "model/messages/message_text.h"
#include "server/config/flag_parser.h"

namespace duet::server::config {
namespace {

constexpr std::size_t kMaxConfigBytes = std::size_t{1} << 20;

// Splits a command line into flags, each with the words that follow it. A negative number is not a
// flag.
std::vector<std::vector<std::string>> SplitFlags(int argc, const char* const* argv) {
  std::vector<std::vector<std::string>> flags;
  for (int i = 1; i < argc; ++i) {
    const absl::string_view word = argv[i];
    const bool is_flag = absl::StartsWith(word, "--") ||
                         (word.size() > 1 && word[0] == '-' && absl::ascii_isalpha(word[1]));
    if (is_flag || flags.empty()) flags.emplace_back();
    flags.back().emplace_back(word);
  }
  return flags;
}

// Merges settings over those of `command_line`. `source` returns the source of a field, given its
// name within `settings`.
template <typename Source>
void Override(const v1::ServerConfig& settings, const Source& source, CommandLine* command_line) {
  using google::protobuf::FieldDescriptor;
  const google::protobuf::Reflection& reflection = *settings.GetReflection();
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

// Parses each flag of a command line separately, so that every mistake is reported and the other
// flags count. `first` is the first mistake of the command line as a whole.
Flags ParseEach(int argc, const char* const* argv, const absl::Status& first,
                CommandLine* command_line) {
  Flags all;
  for (std::vector<std::string>& words : SplitFlags(argc, argv)) {
    const absl::StatusOr<Flags> one = FlagParser().ParseOne(std::move(words));
    AddErrors(one.status(), command_line);
    if (!one.ok()) continue;
    all.config.MergeFrom(one->config);
    if (!one->config_path.empty()) all.config_path = one->config_path;
    if (one->task != Task::kServe) all.task = one->task;
  }
  // Such as a flag that is repeated.
  if (command_line->errors.empty()) AddErrors(first, command_line);
  return all;
}

void ReadFile(const std::string& path, CommandLine* command_line) {
  v1::ServerConfig config;
  messages::FieldPlaces places;
  AddErrors(ReadConfigFile(path, &config, &places), command_line);
  const auto source = [&](const std::string& field) {
    const messages::Place place = places[field];
    return absl::StrCat("file ", path, ":", place.line, ":", place.column);
  };
  Override(config, source, command_line);
}

std::string PrefixLines(absl::string_view prefix, absl::string_view lines) {
  return absl::StrCat(prefix, absl::StrReplaceAll(lines, {{"\n", absl::StrCat("\n", prefix)}}));
}

}  // namespace

absl::StatusOr<v1::ServerConfig> ParseConfigText(std::string_view text, bool json) {
  v1::ServerConfig config;
  const absl::Status status = messages::ParseMessage(
      {text.data(), text.size()},
      json ? messages::MessageSyntax::kJson : messages::MessageSyntax::kTextFormat, &config);
  if (!status.ok()) return status;
  return config;
}

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

CommandLine ParseCommandLine(int argc, const char* const* argv, const Environment& environment) {
  CommandLine command_line;
  absl::StatusOr<Flags> flags = FlagParser().Parse(argc, argv, &command_line.print);
  if (command_line.print.has_value()) return command_line;
  if (!flags.ok()) flags = ParseEach(argc, argv, flags.status(), &command_line);
  std::map<std::string, Flags> variables;
  std::string config_path;
  for (const auto& [name, value] : environment) {
    absl::StatusOr<Flags> variable = FlagParser().ParseVariable(name, value);
    AddErrors(variable.status(), &command_line);
    if (!variable.ok()) continue;
    if (!variable->config_path.empty()) config_path = variable->config_path;
    variables[name] = *std::move(variable);
  }
  if (!flags->config_path.empty()) config_path = flags->config_path;
  if (!config_path.empty()) ReadFile(config_path, &command_line);
  for (const auto& [name, variable] : variables) {
    const std::string source = absl::StrCat("environment ", name);
    Override(
        variable.config, [&source](const std::string&) { return source; }, &command_line);
  }
  command_line.task = flags->task;
  Override(
      flags->config, [](const std::string&) { return "command line"; }, &command_line);
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

}  // namespace duet::server::config

#include "client/cli/settings.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "model/base/file.h"
#include "model/base/text.h"

namespace duet::client::cli {
namespace {

constexpr std::size_t kMaxConfigBytes = std::size_t{1} << 20;
constexpr char kServerVariable[] = "DUET_SERVER";
constexpr char kConfigVariable[] = "DUET_CONFIG";

bool IsFlagName(absl::string_view name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
    return absl::ascii_islower(static_cast<unsigned char>(c)) ||
           absl::ascii_isdigit(static_cast<unsigned char>(c)) || c == '-';
  });
}

// The default path of the file; empty without a home.
std::filesystem::path DefaultFile(const Variables& variables) {
  if (const auto xdg = variables("XDG_CONFIG_HOME"); xdg.has_value() && !xdg->empty()) {
    return std::filesystem::path(*xdg) / "duet" / "config";
  }
  const auto home = variables("HOME");
  if (!home.has_value() || home->empty()) return {};
  return std::filesystem::path(*home) / ".config" / "duet" / "config";
}

absl::StatusOr<std::vector<Setting>> ReadConfig(const Variables& variables) {
  const auto named = variables(kConfigVariable);
  const std::filesystem::path file =
      named.has_value() ? std::filesystem::path(*named) : DefaultFile(variables);
  if (file.empty()) return std::vector<Setting>();
  const absl::StatusOr<std::string> text = base::ReadFile(file, kMaxConfigBytes, "a configuration");
  if (text.ok()) return ParseSettings(*text, file.string());
  if (!named.has_value() && absl::IsNotFound(text.status())) return std::vector<Setting>();
  return absl::Status(text.status().code(),
                      named.has_value()
                          ? absl::StrCat(kConfigVariable, ": ", text.status().message())
                          : std::string(text.status().message()));
}

}  // namespace

absl::StatusOr<std::vector<Setting>> ParseSettings(absl::string_view text,
                                                   absl::string_view source) {
  std::vector<Setting> settings;
  base::LineReader lines(base::SkipByteOrderMark(text));
  for (absl::string_view line; lines.Next(&line);) {
    line = absl::StripAsciiWhitespace(line);
    if (line.empty() || line.front() == '#') continue;
    const std::size_t equals = line.find('=');
    const absl::string_view name = absl::StripAsciiWhitespace(line.substr(0, equals));
    if (equals == absl::string_view::npos || !IsFlagName(name) || absl::StartsWith(name, "-")) {
      return base::ErrorAt(source, lines.number(),
                           absl::StrCat("expected FLAG = VALUE, such as server = lab:50051, got ",
                                        base::Quoted(line)));
    }
    settings.push_back({std::string(name),
                        std::string(absl::StripAsciiWhitespace(line.substr(equals + 1))),
                        absl::StrCat(source, ":", lines.number())});
  }
  return settings;
}

absl::StatusOr<std::vector<Setting>> ReadSettings(const Variables& variables) {
  absl::StatusOr<std::vector<Setting>> settings = ReadConfig(variables);
  if (!settings.ok()) return settings.status();
  const auto server = variables(kServerVariable);
  if (!server.has_value() || server->empty()) return settings;
  const auto is_server = [](const Setting& setting) { return setting.name == "server"; };
  settings->erase(std::remove_if(settings->begin(), settings->end(), is_server), settings->end());
  settings->push_back({"server", *server, kServerVariable});
  return settings;
}

}  // namespace duet::client::cli

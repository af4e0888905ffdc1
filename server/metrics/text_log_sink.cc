#include "server/metrics/text_log_sink.h"

#include <algorithm>
#include <cstddef>
#include <nlohmann/json.hpp>

namespace duet::server::metrics {
namespace {

using Json = nlohmann::ordered_json;

// Unquoted if the end of the value is unambiguous, otherwise as JSON.
std::string ValueText(const Json& value) {
  if (!value.is_string()) return value.dump();
  const std::string text = value.get<std::string>();
  const bool bare = !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return c > ' ' && c < 0x7f && c != '"' && c != '=';
  });
  return bare ? text : value.dump();
}

std::string Word(const Json& line, const char* key) {
  const auto found = line.find(key);
  return found == line.end() || !found->is_string() ? "" : found->get<std::string>();
}

}  // namespace

std::string ToText(std::string_view json_line) {
  constexpr std::size_t kSeverityWidth = 7;  // WARNING
  const Json line = Json::parse(json_line, nullptr, /*allow_exceptions=*/false);
  if (!line.is_object()) return std::string(json_line);
  std::string severity = Word(line, "severity");
  severity.resize(std::max(severity.size(), kSeverityWidth), ' ');
  std::string text = Word(line, "time") + " " + severity + " " + Word(line, "event");
  for (const auto& [key, value] : line.items()) {
    if (key == "time" || key == "severity" || key == "event") continue;
    text += " " + key + "=" + ValueText(value);
  }
  return text;
}

}  // namespace duet::server::metrics

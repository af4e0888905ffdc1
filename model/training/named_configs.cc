#include "model/training/named_configs.h"

#include <cstddef>
#include <nlohmann/json.hpp>

#include "absl/strings/str_cat.h"
#include "model/base/status_macros.h"
#include "model/base/strict_json.h"
#include "model/base/text.h"
#include "model/training/named_configs.inc"

namespace duet::training {
namespace {

using nlohmann::json;
using Replacements = std::vector<std::pair<std::string, std::string>>;

constexpr int kMaxDepth = 4;
constexpr size_t kMaxName = 64;

// Parses a base and the changes to it.
absl::StatusOr<TrainingOptions> ParseDerived(const json& value, const Replacements& replacements) {
  base::ObjectReader reader(value, "");
  const std::string name = reader.String("base", kMaxName);
  const NamedConfig* const base = FindConfig(name);
  if (reader.ok() && base == nullptr) {
    reader.Fail("base", absl::StrCat("expected a named configuration, got ", base::Quoted(name)));
  }
  const json& set = reader.Object("set");
  DUET_RETURN_IF_ERROR(reader.Finish());
  Replacements all;
  for (const auto& [path, setting] : set.items()) all.emplace_back(path, setting.dump());
  all.insert(all.end(), replacements.begin(), replacements.end());
  return ParseConfig(base->json, all);
}

}  // namespace

const NamedConfig* FindConfig(std::string_view name) {
  for (const NamedConfig& config : NamedConfigs()) {
    if (config.name == name) return &config;
  }
  return nullptr;
}

absl::StatusOr<TrainingOptions> ParseConfig(std::string_view text,
                                            const Replacements& replacements) {
  DUET_TRY(const json value, base::ParseStrictJson(text, kMaxDepth));
  if (value.contains("base")) return ParseDerived(value, replacements);
  return ParseTrainingOptions(text, replacements);
}

}  // namespace duet::training

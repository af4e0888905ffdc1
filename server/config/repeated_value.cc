#include "server/config/repeated_value.h"

#include <cstdint>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/strings/string_view.h"
#include "absl/strings/strip.h"
#include "model/base/text.h"

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

}  // namespace

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

}  // namespace duet::server::config

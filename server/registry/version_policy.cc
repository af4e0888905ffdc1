#include "server/registry/version_policy.h"

#include <algorithm>

namespace duet::server::registry {

bool VersionPolicy::Names(uint32_t version) const {
  return versions.empty() || std::find(versions.begin(), versions.end(), version) != versions.end();
}

VersionPolicy PolicyOf(absl::string_view model, const std::vector<VersionPolicy>& policies) {
  for (const VersionPolicy& policy : policies) {
    if (policy.model == model) return policy;
  }
  for (const VersionPolicy& policy : policies) {
    if (policy.model.empty()) return policy;
  }
  return {};
}

}  // namespace duet::server::registry

#ifndef DUET_SERVER_REGISTRY_VERSION_POLICY_H_
#define DUET_SERVER_REGISTRY_VERSION_POLICY_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "absl/strings/string_view.h"

namespace duet::server::registry {

// Which versions of a model in the repository are served: every one unless told otherwise.
struct VersionPolicy {
  std::string model;               // empty: every model without a policy of its own
  std::optional<uint32_t> latest;  // so many, the newest that load
  std::vector<uint32_t> versions;  // these alone, where there are any

  bool Names(uint32_t version) const;
};

// The policy of a model; the first that fits of several.
VersionPolicy PolicyOf(absl::string_view model, const std::vector<VersionPolicy>& policies);

}  // namespace duet::server::registry

#endif  // DUET_SERVER_REGISTRY_VERSION_POLICY_H_

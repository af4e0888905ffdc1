#ifndef DUET_SERVER_REGISTRY_VERSION_POLICY_H_
#define DUET_SERVER_REGISTRY_VERSION_POLICY_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "absl/strings/string_view.h"

namespace duet::server::registry {

// A name that requests may use instead of a version number: "stable", "canary".
struct VersionLabel {
  std::string model;
  std::string label;
  uint32_t version = 0;
  friend bool operator==(const VersionLabel& a, const VersionLabel& b) {
    return a.model == b.model && a.label == b.label && a.version == b.version;
  }
};

// Which versions of a model in the repository are served. Default: all.
struct VersionPolicy {
  std::string model;               // empty: every model without a policy of its own
  std::optional<uint32_t> latest;  // only this many of the newest versions that load
  std::vector<uint32_t> versions;  // if not empty, only these

  bool Names(uint32_t version) const;
};

// Returns the first policy for a model.
VersionPolicy PolicyOf(absl::string_view model, const std::vector<VersionPolicy>& policies);

}  // namespace duet::server::registry

#endif  // DUET_SERVER_REGISTRY_VERSION_POLICY_H_

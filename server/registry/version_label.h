#ifndef DUET_SERVER_REGISTRY_VERSION_LABEL_H_
#define DUET_SERVER_REGISTRY_VERSION_LABEL_H_

#include <cstdint>
#include <string>

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

}  // namespace duet::server::registry

#endif  // DUET_SERVER_REGISTRY_VERSION_LABEL_H_

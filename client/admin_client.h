#ifndef DUET_CLIENT_ADMIN_CLIENT_H_
#define DUET_CLIENT_ADMIN_CLIENT_H_

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/options.h"

namespace duet::client {

// How it stands with one version on a server.
struct ServedVersion {
  enum class State { kUnknown, kLoading, kServed, kFailed, kUnloaded };
  std::string name;
  uint32_t version = 0;
  State state = State::kUnknown;
  std::string error;  // why its last load failed; empty if it succeeded
  std::vector<std::string> version_labels;
  bool is_default = false;
  double load_seconds = 0;
  bool outdated = false;  // served from an earlier load, because the last one failed
};

// A folder in the server's model repository that is no checkpoint.
struct SkippedFolder {
  std::string folder;
  std::string reason;
};

struct ServedModels {
  std::vector<ServedVersion> models;  // by name, newest version first
  std::vector<SkippedFolder> skipped_folders;
  // Certificates and access files that the server refused; those before them are still in use.
  std::vector<std::string> problems;
};

// What a reload did; versions as "name/version".
struct ReloadResult {
  std::vector<std::string> loaded;
  std::vector<std::string> refused;  // ServedVersion::error tells why
  std::vector<std::string> unloaded;
  uint32_t unchanged = 0;
  std::vector<std::string> problems;

  // Whether everything is as the server's configuration has it.
  bool ok() const { return refused.empty() && problems.empty(); }
};

// Tells a running server what to serve, by its admin service (duet.admin.v1), which has an address
// of its own.
//
// Errors:  the server's status, whose message says what is wrong. Nothing is tried twice.
// Threads: safe to call concurrently.
class AdminClient {
 public:
  // INVALID_ARGUMENT when an option makes no sense. Does not connect yet.
  static absl::StatusOr<std::unique_ptr<AdminClient>> Create(const ClientOptions& options);

  virtual ~AdminClient() = default;
  virtual absl::StatusOr<ServedModels> ListModels() = 0;
  // Both come back once the version is served, or no longer.
  virtual absl::Status LoadModel(const std::string& name, uint32_t version) = 0;
  virtual absl::Status UnloadModel(const std::string& name, uint32_t version) = 0;
  // Has the server read configuration and model repository again.
  virtual absl::StatusOr<ReloadResult> Reload() = 0;
  virtual absl::Status SetLabel(const std::string& name, const std::string& label,
                                uint32_t version) = 0;
  virtual absl::Status DeleteLabel(const std::string& name, const std::string& label) = 0;
};

}  // namespace duet::client

#endif  // DUET_CLIENT_ADMIN_CLIENT_H_

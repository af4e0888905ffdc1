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

// State of one model version on a server.
struct ServedVersion {
  enum class State { kUnknown, kLoading, kServed, kFailed, kUnloaded };
  std::string name;
  uint32_t version = 0;
  State state = State::kUnknown;
  std::string error;  // why its last load failed; empty if it succeeded
  std::vector<std::string> version_labels;
  bool is_default = false;
  double load_seconds = 0;
  bool outdated = false;  // served from an earlier load because the last load failed
};

// A folder in the server's model repository that is not a checkpoint.
struct SkippedFolder {
  std::string folder;
  std::string reason;
};

struct ServedModels {
  std::vector<ServedVersion> models;  // by name, newest version first
  std::vector<SkippedFolder> skipped_folders;
  // Certificates and access files that the server rejected. It keeps using the previous ones.
  std::vector<std::string> problems;
};

// Result of a reload. Versions are written "name/version".
struct ReloadResult {
  std::vector<std::string> loaded;
  std::vector<std::string> refused;  // ServedVersion::error has the reason
  std::vector<std::string> unloaded;
  uint32_t unchanged = 0;
  std::vector<std::string> problems;

  // True if the server serves everything that its configuration specifies.
  bool ok() const { return refused.empty() && problems.empty(); }
};

// Controls which models a running server serves, through its admin service (duet.admin.v1). The
// admin service has its own address.
//
// Errors:  the server's status. Calls are not retried.
// Threads: safe to call concurrently.
class AdminClient {
 public:
  // Returns INVALID_ARGUMENT if an option is invalid. Connects with the first call.
  static absl::StatusOr<std::unique_ptr<AdminClient>> Create(const ClientOptions& options);

  virtual ~AdminClient() = default;
  virtual absl::StatusOr<ServedModels> ListModels() = 0;
  // Both return after the version has been loaded or unloaded.
  virtual absl::Status LoadModel(const std::string& name, uint32_t version) = 0;
  virtual absl::Status UnloadModel(const std::string& name, uint32_t version) = 0;
  // Makes the server read its configuration and its model repository again.
  virtual absl::StatusOr<ReloadResult> Reload() = 0;
  virtual absl::Status SetLabel(const std::string& name, const std::string& label,
                                uint32_t version) = 0;
  virtual absl::Status DeleteLabel(const std::string& name, const std::string& label) = 0;
};

}  // namespace duet::client

#endif  // DUET_CLIENT_ADMIN_CLIENT_H_

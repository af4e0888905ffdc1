#ifndef DUET_SERVER_REGISTRY_MODEL_REGISTRY_H_
#define DUET_SERVER_REGISTRY_MODEL_REGISTRY_H_

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"
#include "model/engine/synthesizer.h"
#include "server/common/mutex.h"

namespace duet::server::registry {

// Selects a model. If all fields are empty: the newest version of the default model.
struct ModelQuery {
  std::string name;
  std::optional<uint32_t> version;
  std::optional<std::string> version_label;
};

// A model version that the server serves.
struct ServedModel {
  std::shared_ptr<const engine::Synthesizer> model;
  std::vector<std::string> version_labels;  // sorted
  bool is_default = false;
};

// The part of a query that matches no served model.
struct ModelNotFound {
  std::string field;        // of the request: "model.name", "model.version", "model.version_label"
  std::string description;  // the value, and what the server serves
};

using FindResult = std::variant<ServedModel, ModelNotFound>;

// The served models, by name and version.
//
// Find returns shared ownership, so a call keeps its model when it is replaced here. A label always
// points to a served version. Once set, the default model always has a served version.
// Threads: safe to call concurrently.
class ModelRegistry {
 public:
  // Serves a model under its description's name and version. Replaces an existing one.
  void Serve(std::shared_ptr<const engine::Synthesizer> model);

  // Points a label of a model to a version. Returns NOT_FOUND if that version is not served.
  absl::Status SetLabel(absl::string_view name, absl::string_view label, uint32_t version);

  // Returns NOT_FOUND if the label does not exist.
  absl::Status DeleteLabel(absl::string_view name, absl::string_view label);

  // Stops serving a version. Calls in progress keep it. Returns NOT_FOUND if it is not served, and
  // FAILED_PRECONDITION if a label points to it or it is the last version of the default model.
  absl::Status Remove(absl::string_view name, uint32_t version);

  // Sets the model for requests that name none. Until then, it is the first one by name. Returns
  // NOT_FOUND if no version of it is served.
  absl::Status SetDefault(absl::string_view name);

  FindResult Find(const ModelQuery& query) const;

  // Returns every version, by name, newest first.
  std::vector<ServedModel> List() const;

  // Returns the name of the default model; empty if no model is served.
  std::string default_model() const;

 private:
  using Versions = std::map<uint32_t, std::shared_ptr<const engine::Synthesizer>, std::greater<>>;
  struct Entry {
    Versions versions;
    std::map<std::string, uint32_t, std::less<>> labels;
  };
  using Entries = std::map<std::string, Entry, std::less<>>;

  const std::string& DefaultName() const DUET_REQUIRES(mutex_);
  // Returns OK if a served version may be removed.
  absl::Status CheckRemovable(absl::string_view name, const Entry& entry, uint32_t version) const
      DUET_REQUIRES(mutex_);
  ServedModel Describe(const std::string& name, const Entry& entry, uint32_t version) const
      DUET_REQUIRES(mutex_);

  mutable common::Mutex mutex_;
  Entries entries_ DUET_GUARDED_BY(mutex_);
  std::string default_name_ DUET_GUARDED_BY(mutex_);
};

}  // namespace duet::server::registry

#endif  // DUET_SERVER_REGISTRY_MODEL_REGISTRY_H_

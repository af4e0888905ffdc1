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

// Which model a request asks for. All empty: the default model's newest version.
struct ModelQuery {
  std::string name;
  std::optional<uint32_t> version;
  std::optional<std::string> version_label;
};

// A model version being served.
struct ServedModel {
  std::shared_ptr<const engine::Synthesizer> model;
  std::vector<std::string> version_labels;  // sorted
  bool is_default = false;
};

// What of a query nothing that is served answers to.
struct ModelNotFound {
  std::string field;        // of the request: "model.name", "model.version", "model.version_label"
  std::string description;  // what came, and what is served
};

using FindResult = std::variant<ServedModel, ModelNotFound>;

// The models being served, by name and version.
//
// Find hands out shared ownership: a call keeps its model when another takes its place here. A
// label always points at a version that is served, and the default model, once set, always has one.
// Threads: safe to call concurrently.
class ModelRegistry {
 public:
  // Serves a model under its description's name and version, in place of one already there.
  void Serve(std::shared_ptr<const engine::Synthesizer> model);

  // Points a label of a model at a version, in place of where it pointed before.
  // NOT_FOUND when that version is not served.
  absl::Status SetLabel(absl::string_view name, absl::string_view label, uint32_t version);

  // NOT_FOUND when there is no such label.
  absl::Status DeleteLabel(absl::string_view name, absl::string_view label);

  // Serves a version no longer; calls that found it go on. NOT_FOUND when it is not served,
  // FAILED_PRECONDITION when a label points at it or it is the default model's last.
  absl::Status Remove(absl::string_view name, uint32_t version);

  // The model that answers when a request names none; until set, the first name in order.
  // NOT_FOUND when no version of it is served.
  absl::Status SetDefault(absl::string_view name);

  FindResult Find(const ModelQuery& query) const;

  // Every version, by name, newest first.
  std::vector<ServedModel> List() const;

  // The versions that labels of a model point at.
  std::vector<uint32_t> LabelledVersions(absl::string_view name) const;

  // The name of the default model; empty while nothing is served.
  std::string default_model() const;

 private:
  using Versions = std::map<uint32_t, std::shared_ptr<const engine::Synthesizer>, std::greater<>>;
  struct Entry {
    Versions versions;
    std::map<std::string, uint32_t, std::less<>> labels;
  };
  using Entries = std::map<std::string, Entry, std::less<>>;

  const std::string& DefaultName() const DUET_REQUIRES(mutex_);
  // Whether a version that is served may be taken away.
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

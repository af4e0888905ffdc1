#include "server/registry/model_registry.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/base/text.h"

namespace duet::server::registry {
namespace {

template <typename Map>
std::string Keys(const Map& map) {
  if (map.empty()) return "none";
  return absl::StrJoin(
      map, ", ", [](std::string* out, const auto& entry) { absl::StrAppend(out, entry.first); });
}

absl::Status NotServed(absl::string_view name, uint32_t version) {
  return absl::NotFoundError(
      absl::StrCat("version ", version, " of model ", base::Quoted(name), " is not served"));
}

}  // namespace

void ModelRegistry::Serve(std::shared_ptr<const engine::Synthesizer> model) {
  const engine::ModelDescription& description = model->description();
  common::MutexLock lock(mutex_);
  // The previous model is freed with the parameter, after the lock, because freeing takes time.
  entries_[description.name].versions[static_cast<uint32_t>(description.version)].swap(model);
}

absl::Status ModelRegistry::SetLabel(absl::string_view name, absl::string_view label,
                                     uint32_t version) {
  common::MutexLock lock(mutex_);
  const auto entry = entries_.find(name);
  if (entry == entries_.end() || entry->second.versions.count(version) == 0) {
    return absl::NotFoundError(absl::StrCat("version label ", base::Quoted(label),
                                            " points at version ", version, " of model ",
                                            base::Quoted(name), ", which is not served"));
  }
  entry->second.labels[std::string(label)] = version;
  return absl::OkStatus();
}

absl::Status ModelRegistry::DeleteLabel(absl::string_view name, absl::string_view label) {
  common::MutexLock lock(mutex_);
  const auto entry = entries_.find(name);
  if (entry == entries_.end()) {
    return absl::NotFoundError(absl::StrCat("model ", base::Quoted(name), " is not served"));
  }
  const auto found = entry->second.labels.find(label);
  if (found == entry->second.labels.end()) {
    return absl::NotFoundError(absl::StrCat("version label: expected a label of model ",
                                            base::Quoted(name), " (", Keys(entry->second.labels),
                                            "), got ", base::Quoted(label)));
  }
  entry->second.labels.erase(found);
  return absl::OkStatus();
}

absl::Status ModelRegistry::CheckRemovable(absl::string_view name, const Entry& entry,
                                           uint32_t version) const {
  for (const auto& [label, labelled] : entry.labels) {
    if (labelled != version) continue;
    return absl::FailedPreconditionError(absl::StrCat("version label ", base::Quoted(label),
                                                      " points at version ", version, " of model ",
                                                      base::Quoted(name)));
  }
  if (entry.versions.size() > 1 || name != DefaultName()) return absl::OkStatus();
  return absl::FailedPreconditionError(absl::StrCat(
      "version ", version, " is the last version of the default model ", base::Quoted(name)));
}

absl::Status ModelRegistry::Remove(absl::string_view name, uint32_t version) {
  std::shared_ptr<const engine::Synthesizer> removed;  // is freed after the lock
  common::MutexLock lock(mutex_);
  const auto entry = entries_.find(name);
  if (entry == entries_.end()) return NotServed(name, version);
  const auto found = entry->second.versions.find(version);
  if (found == entry->second.versions.end()) return NotServed(name, version);
  const absl::Status removable = CheckRemovable(name, entry->second, version);
  if (!removable.ok()) return removable;
  removed = std::move(found->second);
  entry->second.versions.erase(found);
  if (entry->second.versions.empty()) entries_.erase(entry);
  return absl::OkStatus();
}

absl::Status ModelRegistry::SetDefault(absl::string_view name) {
  common::MutexLock lock(mutex_);
  if (entries_.find(name) == entries_.end()) {
    return absl::NotFoundError(absl::StrCat("default_model: expected a served model (",
                                            Keys(entries_), "), got ", base::Quoted(name)));
  }
  default_name_ = std::string(name);
  return absl::OkStatus();
}

const std::string& ModelRegistry::DefaultName() const {
  return default_name_.empty() && !entries_.empty() ? entries_.begin()->first : default_name_;
}

ServedModel ModelRegistry::Describe(const std::string& name, const Entry& entry,
                                    uint32_t version) const {
  ServedModel served;
  served.model = entry.versions.at(version);
  served.is_default = name == DefaultName() && version == entry.versions.begin()->first;
  for (const auto& [label, labelled] : entry.labels) {
    if (labelled == version) served.version_labels.push_back(label);
  }
  return served;
}

FindResult ModelRegistry::Find(const ModelQuery& query) const {
  common::MutexLock lock(mutex_);
  const std::string& name = query.name.empty() ? DefaultName() : query.name;
  const auto found = entries_.find(name);
  if (found == entries_.end()) {
    return ModelNotFound{"model.name", absl::StrCat("expected a served model (", Keys(entries_),
                                                    "), got ", base::Quoted(name))};
  }
  const Entry& entry = found->second;
  uint32_t version = entry.versions.begin()->first;
  if (query.version_label.has_value()) {
    const auto label = entry.labels.find(*query.version_label);
    if (label == entry.labels.end()) {
      return ModelNotFound{"model.version_label", absl::StrCat("expected a label of model ", name,
                                                               " (", Keys(entry.labels), "), got ",
                                                               base::Quoted(*query.version_label))};
    }
    version = label->second;
  }
  if (query.version.has_value()) {
    version = *query.version;
    if (entry.versions.count(version) == 0) {
      return ModelNotFound{"model.version",
                           absl::StrCat("expected a served version of model ", name, " (",
                                        Keys(entry.versions), "), got ", version)};
    }
  }
  return Describe(found->first, entry, version);
}

std::string ModelRegistry::default_model() const {
  common::MutexLock lock(mutex_);
  return DefaultName();
}

std::vector<ServedModel> ModelRegistry::List() const {
  common::MutexLock lock(mutex_);
  std::vector<ServedModel> models;
  for (const auto& [name, entry] : entries_) {
    for (const auto& [version, model] : entry.versions) {
      models.push_back(Describe(name, entry, version));
    }
  }
  return models;
}

}  // namespace duet::server::registry

#include "server/admin/admin_message.h"

#include <algorithm>
#include <cstddef>
#include <string>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/base/text.h"
#include "server/common/error_details.h"

namespace duet::server::admin {
namespace {

constexpr std::size_t kLongestLabel = 63;

// Collects the violations of a request.
class Fields {
 public:
  Fields& Name(const std::string& name) {
    if (name.empty()) Add("name", "expected a model's name, got none");
    return *this;
  }
  Fields& Version(uint32_t version) {
    if (version == 0) Add("version", "expected a version of 1 or more, got none");
    return *this;
  }
  Fields& Label(const std::string& label) {
    const bool plain = std::all_of(label.begin(), label.end(), [](char c) {
      return absl::ascii_isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_' || c == '.';
    });
    if (plain && !label.empty() && label.size() <= kLongestLabel) return *this;
    Add("label", absl::StrCat("expected 1 to ", kLongestLabel,
                              " letters, digits, '-', '_' and '.', got ", base::Quoted(label)));
    return *this;
  }

  absl::Status status() const {
    if (violations_.empty()) return absl::OkStatus();
    absl::Status status = absl::InvalidArgumentError(absl::StrJoin(
        violations_, "; ", [](std::string* out, const common::FieldViolation& violation) {
          absl::StrAppend(out, violation.field, ": ", violation.description);
        }));
    common::AddBadRequest(status, violations_);
    return status;
  }

 private:
  void Add(std::string field, std::string description) {
    violations_.push_back({std::move(field), std::move(description)});
  }
  std::vector<common::FieldViolation> violations_;
};

v1::ModelState ToMessage(registry::ModelState state) {
  switch (state) {
    case registry::ModelState::kLoading:
      return v1::MODEL_STATE_LOADING;
    case registry::ModelState::kServed:
      return v1::MODEL_STATE_SERVED;
    case registry::ModelState::kFailed:
      return v1::MODEL_STATE_FAILED;
    case registry::ModelState::kUnloaded:
      return v1::MODEL_STATE_UNLOADED;
  }
  return v1::MODEL_STATE_UNSPECIFIED;
}

}  // namespace

v1::ListModelsResponse ToMessage(const std::vector<registry::ModelStatus>& models,
                                 const std::vector<registry::SkippedFolder>& skipped,
                                 const std::vector<std::string>& problems) {
  v1::ListModelsResponse response;
  for (const registry::ModelStatus& model : models) {
    v1::ModelVersion* message = response.add_models();
    message->set_name(model.name);
    message->set_version(model.version);
    message->set_state(ToMessage(model.state));
    message->set_error(model.error);
    for (const std::string& label : model.version_labels) message->add_version_labels(label);
    message->set_is_default(model.is_default);
    message->set_load_seconds(model.load_seconds);
    message->set_outdated(model.outdated);
  }
  for (const registry::SkippedFolder& folder : skipped) {
    v1::SkippedFolder* message = response.add_skipped_folders();
    message->set_folder(folder.folder);
    message->set_reason(folder.reason);
  }
  for (const std::string& problem : problems) response.add_problems(problem);
  return response;
}

v1::ReloadResponse ToMessage(const registry::ReloadReport& report) {
  v1::ReloadResponse response;
  for (const std::string& version : report.loaded) response.add_loaded(version);
  for (const std::string& version : report.refused) response.add_refused(version);
  for (const std::string& version : report.unloaded) response.add_unloaded(version);
  response.set_unchanged_count(static_cast<uint32_t>(report.unchanged));
  for (const std::string& problem : report.problems) response.add_problems(problem);
  for (const std::string& label : report.refused_labels) response.add_problems(label);
  return response;
}

absl::Status Validate(const v1::ListModelsRequest&) { return absl::OkStatus(); }

absl::Status Validate(const v1::LoadModelRequest& request) {
  return Fields().Name(request.name()).Version(request.version()).status();
}

absl::Status Validate(const v1::UnloadModelRequest& request) {
  return Fields().Name(request.name()).Version(request.version()).status();
}

absl::Status Validate(const v1::ReloadRequest&) { return absl::OkStatus(); }

absl::Status Validate(const v1::SetLabelRequest& request) {
  return Fields().Name(request.name()).Label(request.label()).Version(request.version()).status();
}

absl::Status Validate(const v1::DeleteLabelRequest& request) {
  return Fields().Name(request.name()).Label(request.label()).status();
}

}  // namespace duet::server::admin

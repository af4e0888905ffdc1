#ifndef DUET_SERVER_ADMIN_ADMIN_MESSAGE_H_
#define DUET_SERVER_ADMIN_ADMIN_MESSAGE_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "duet/admin/v1/admin.pb.h"
#include "server/registry/model_repository.h"
#include "server/registry/model_status.h"

namespace duet::server::admin {

namespace v1 = ::duet::admin::v1;

// Convert the registry's types to messages.
v1::ListModelsResponse ToMessage(const std::vector<registry::ModelStatus>& models,
                                 const std::vector<registry::SkippedFolder>& skipped,
                                 const std::vector<std::string>& problems);
v1::ReloadResponse ToMessage(const registry::ReloadReport& report);

// Fail with INVALID_ARGUMENT and every field that is missing or is not a valid label: 1 to 63
// letters, digits, '-', '_' and '.'.
absl::Status Validate(const v1::ListModelsRequest& request);
absl::Status Validate(const v1::LoadModelRequest& request);
absl::Status Validate(const v1::UnloadModelRequest& request);
absl::Status Validate(const v1::ReloadRequest& request);
absl::Status Validate(const v1::SetLabelRequest& request);
absl::Status Validate(const v1::DeleteLabelRequest& request);

}  // namespace duet::server::admin

#endif  // DUET_SERVER_ADMIN_ADMIN_MESSAGE_H_

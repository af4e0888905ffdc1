#include "client/internal/grpc_status.h"

#include <string>
#include <vector>

#include "absl/strings/cord.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "client/error_details.h"
#include "duet/rpc/v1/status.pb.h"

namespace duet::client::internal {
namespace {

// Returns "field: description" of each violation that the status's message does not contain.
std::string MissingViolations(const absl::Status& status) {
  std::vector<std::string> missing;
  for (const FieldViolation& violation : FieldViolations(status)) {
    if (absl::StrContains(status.message(), violation.field) &&
        absl::StrContains(status.message(), violation.description)) {
      continue;
    }
    missing.push_back(
        absl::StrCat(violation.field, violation.field.empty() ? "" : ": ", violation.description));
  }
  return absl::StrJoin(missing, "; ");
}

}  // namespace

std::unique_ptr<grpc::ClientContext> NewContext(absl::Time deadline, const std::string& token,
                                                const std::string& request_id) {
  auto context = std::make_unique<grpc::ClientContext>();
  context->set_deadline(absl::ToChronoTime(deadline));
  if (!token.empty()) context->AddMetadata("authorization", "Bearer " + token);
  if (!request_id.empty()) context->AddMetadata("x-request-id", request_id);
  return context;
}

absl::Status WithPayloadsOf(const absl::Status& from, absl::Status to) {
  from.ForEachPayload([&to](absl::string_view type_url, const absl::Cord& payload) {
    to.SetPayload(type_url, payload);
  });
  return to;
}

absl::Status AppendMessage(const absl::Status& status, std::string_view more) {
  return WithPayloadsOf(
      status, absl::Status(status.code(), absl::StrCat(status.message(), std::string(more))));
}

bool IsBrokenConnection(const absl::Status& status) {
  switch (status.code()) {
    case absl::StatusCode::kOk:
    case absl::StatusCode::kUnavailable:
      return true;
    case absl::StatusCode::kInternal:
    case absl::StatusCode::kUnknown:
    case absl::StatusCode::kCancelled:
      return ErrorReason(status).empty();
    default:
      return false;
  }
}

absl::Status FromGrpc(const grpc::Status& status) {
  if (status.ok()) return absl::OkStatus();
  absl::Status result(static_cast<absl::StatusCode>(status.error_code()), status.error_message());
  rpc::v1::Status details;
  if (details.ParseFromString(status.error_details())) {
    for (const google::protobuf::Any& detail : details.details()) {
      result.SetPayload(detail.type_url(), absl::Cord(detail.value()));
    }
  }
  const std::string missing = MissingViolations(result);
  if (missing.empty()) return result;
  return AppendMessage(result, absl::StrCat(result.message().empty() ? "" : ": ", missing));
}

}  // namespace duet::client::internal

#include "server/service/violations.h"

#include <utility>

#include "absl/strings/str_cat.h"

namespace duet::server::service {
namespace {

constexpr std::size_t kMaxKept = 24;
constexpr std::size_t kMaxKeptBytes = 2000;
constexpr std::size_t kMaxDescriptionBytes = 240;
// Number of violations in grpc-message, for people who see only the text.
constexpr std::size_t kInMessage = 2;

}  // namespace

void Violations::Malformed(std::string field, absl::string_view expected, absl::string_view got) {
  ++malformed_;
  Keep(std::move(field), expected, got);
}

void Violations::Mismatch(std::string field, absl::string_view expected, absl::string_view got) {
  ++mismatched_;
  Keep(std::move(field), expected, got);
}

void Violations::Keep(std::string field, absl::string_view expected, absl::string_view got) {
  field.insert(0, prefix_);
  std::string description = absl::StrCat("expected ", expected, ", got ", got);
  // Descriptions are ASCII (see Quoted), so they can be cut anywhere.
  if (description.size() > kMaxDescriptionBytes) {
    description.resize(kMaxDescriptionBytes);
    description += "...";
  }
  const std::size_t bytes = field.size() + description.size();
  if (kept_.size() >= kMaxKept || kept_bytes_ + bytes > kMaxKeptBytes) return;
  kept_bytes_ += bytes;
  kept_.push_back({std::move(field), std::move(description)});
}

absl::Status Violations::ToStatus() const {
  if (empty()) return absl::OkStatus();
  const std::size_t count = malformed_ + mismatched_;
  std::string message;
  for (std::size_t i = 0; i < kept_.size() && i < kInMessage; ++i) {
    absl::StrAppend(&message, i == 0 ? "" : "; ", kept_[i].field,
                    kept_[i].field.empty() ? "" : ": ", kept_[i].description);
  }
  if (count > kInMessage) absl::StrAppend(&message, "; and ", count - kInMessage, " more");

  std::vector<common::FieldViolation> violations = kept_;
  if (count > kept_.size()) {
    violations.push_back(
        {"", absl::StrCat(count - kept_.size(), " further violations are not listed")});
  }
  absl::Status status =
      malformed_ > 0 ? absl::InvalidArgumentError(message) : absl::FailedPreconditionError(message);
  AddBadRequest(status, violations);
  common::AddErrorInfo(
      status, malformed_ > 0 ? common::kReasonInvalidRequest : common::kReasonModelMismatch);
  return status;
}

}  // namespace duet::server::service

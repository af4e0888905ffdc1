#ifndef DUET_SERVER_SERVICE_VIOLATIONS_H_
#define DUET_SERVER_SERVICE_VIOLATIONS_H_

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"
#include "server/common/error_details.h"

namespace duet::server::service {

// Collects every invalid field of a request, so that a caller can correct all of them at once.
//
// Only the first few are kept as text, because trailers are limited to 8 KiB by clients. The others
// are counted.
class Violations {
 public:
  // `prefix`: precedes every field, such as "start.".
  explicit Violations(std::string prefix = "") : prefix_(std::move(prefix)) {}

  // Adds a field that is malformed for every model: "<field>: expected <expected>, got <got>".
  void Malformed(std::string field, absl::string_view expected, absl::string_view got);
  // Adds a field that is well formed but does not fit the model.
  void Mismatch(std::string field, absl::string_view expected, absl::string_view got);

  bool empty() const { return malformed_ + mismatched_ == 0; }

  // Returns OK if empty, INVALID_ARGUMENT if any field is malformed, and FAILED_PRECONDITION if
  // fields only do not fit the model. Errors have BadRequest and ErrorInfo.
  absl::Status ToStatus() const;

 private:
  void Keep(std::string field, absl::string_view expected, absl::string_view got);

  const std::string prefix_;
  std::vector<common::FieldViolation> kept_;
  std::size_t kept_bytes_ = 0;
  std::size_t malformed_ = 0;
  std::size_t mismatched_ = 0;
};

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_VIOLATIONS_H_

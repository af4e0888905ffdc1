#ifndef DUET_SERVER_SERVICE_VIOLATIONS_H_
#define DUET_SERVER_SERVICE_VIOLATIONS_H_

#include <cstddef>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "server/common/error_details.h"

namespace duet::server::service {

// Collects everything that is wrong with a request, so that a caller can put it right in one go.
//
// Only the first few are kept as text, because they travel in trailers, which clients cap at 8 KiB;
// the rest are counted.
class Violations {
 public:
  // The field is malformed, whatever the model.
  void Malformed(std::string field, std::string description);
  // The field is well formed but does not fit the model.
  void Mismatch(std::string field, std::string description);

  bool empty() const { return malformed_ + mismatched_ == 0; }

  // OK when empty. INVALID_ARGUMENT when anything is malformed, FAILED_PRECONDITION when all that
  // is wrong does not fit the model; with BadRequest and ErrorInfo.
  absl::Status ToStatus() const;

 private:
  void Keep(std::string field, std::string description);

  std::vector<common::FieldViolation> kept_;
  std::size_t kept_bytes_ = 0;
  std::size_t malformed_ = 0;
  std::size_t mismatched_ = 0;
};

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_VIOLATIONS_H_

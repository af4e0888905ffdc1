#ifndef DUET_SERVER_COMMON_JOIN_STATUS_H_
#define DUET_SERVER_COMMON_JOIN_STATUS_H_

#include <vector>

#include "absl/status/status.h"

namespace duet::server::common {

// Returns all failures as one status: the code of the first, and one message per line. OK if none
// failed.
absl::Status Join(const std::vector<absl::Status>& statuses);

}  // namespace duet::server::common

#endif  // DUET_SERVER_COMMON_JOIN_STATUS_H_

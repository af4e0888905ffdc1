#ifndef DUET_SERVER_COMMON_JOIN_STATUS_H_
#define DUET_SERVER_COMMON_JOIN_STATUS_H_

#include <vector>

#include "absl/status/status.h"

namespace duet::server::common {

// All failures as one status: the first one's code, and their messages line by line. OK when none
// failed.
absl::Status Join(const std::vector<absl::Status>& statuses);

}  // namespace duet::server::common

#endif  // DUET_SERVER_COMMON_JOIN_STATUS_H_

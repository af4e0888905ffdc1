#ifndef DUET_SERVER_METRICS_ADMIN_ACTION_H_
#define DUET_SERVER_METRICS_ADMIN_ACTION_H_

#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"

namespace duet::server::metrics {

// An action of an administrator, successful or not: one line of the audit log (JsonLog::Audit).
struct AdminAction {
  std::string caller;  // known by token or certificate; empty for an unknown caller
  std::string peer;
  std::string request_id;
  std::string action;                                          // "LoadModel"
  std::vector<std::pair<std::string, std::string>> arguments;  // {"model", "sbu"}, ...
  absl::Status status;                                         // the result
};

}  // namespace duet::server::metrics

#endif  // DUET_SERVER_METRICS_ADMIN_ACTION_H_

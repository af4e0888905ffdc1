#ifndef DUET_SERVER_METRICS_ADMIN_ACTION_H_
#define DUET_SERVER_METRICS_ADMIN_ACTION_H_

#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"

namespace duet::server::metrics {

// What somebody did, or tried to do, to the server: a line of the audit (JsonLog::Audit).
struct AdminAction {
  std::string caller;  // by token or certificate; empty for somebody unknown
  std::string peer;
  std::string request_id;
  std::string action;                                          // "LoadModel"
  std::vector<std::pair<std::string, std::string>> arguments;  // {"model", "sbu"}, ...
  absl::Status status;                                         // what came of it
};

}  // namespace duet::server::metrics

#endif  // DUET_SERVER_METRICS_ADMIN_ACTION_H_

#ifndef DUET_SERVER_LIFECYCLE_CHECK_HEALTH_H_
#define DUET_SERVER_LIFECYCLE_CHECK_HEALTH_H_

#include "absl/status/status.h"
#include "duet/v1/server_config.pb.h"

namespace duet::server::lifecycle {

// Asks the server that runs on this machine with these settings for /healthz, which needs neither
// certificates nor tokens. Without a metrics port, checks whether its gRPC port accepts
// connections. Fails with UNAVAILABLE and the reason if the server is not healthy.
absl::Status CheckHealth(const v1::ServerConfig& settings, double timeout_seconds);

}  // namespace duet::server::lifecycle

#endif  // DUET_SERVER_LIFECYCLE_CHECK_HEALTH_H_

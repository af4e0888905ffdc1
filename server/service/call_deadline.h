#ifndef DUET_SERVER_SERVICE_CALL_DEADLINE_H_
#define DUET_SERVER_SERVICE_CALL_DEADLINE_H_

#include <grpcpp/server_context.h>

namespace duet::server::service {

// Seconds until a call's deadline, negative once it has passed, infinite where it has none.
//
// Not by the context's deadline(): a caller may ask for 99,999,999 hours, which overflow there.
double SecondsLeft(const grpc::ServerContextBase& context);

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_CALL_DEADLINE_H_

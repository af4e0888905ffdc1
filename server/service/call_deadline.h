#ifndef DUET_SERVER_SERVICE_CALL_DEADLINE_H_
#define DUET_SERVER_SERVICE_CALL_DEADLINE_H_

#include <grpcpp/server_context.h>

namespace duet::server::service {

// Returns the seconds until a call's deadline: negative if it has passed, infinite if there is
// none.
//
// Does not use the context's deadline(), which overflows for a timeout of 99,999,999 hours, the
// maximum of the wire format.
double SecondsLeft(const grpc::ServerContextBase& context);

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_CALL_DEADLINE_H_

#ifndef DUET_SERVER_SERVICE_WIRE_H_
#define DUET_SERVER_SERVICE_WIRE_H_

#include <google/protobuf/message.h>
#include <grpcpp/support/byte_buffer.h>

#include "absl/status/status.h"

namespace duet::server::service {

// Messages and the bytes that travel. The service takes bytes, because gRPC's generated code would
// refuse malformed ones as UNIMPLEMENTED, and parses a request only once it is known that it will
// be small enough when parsed (wire_survey.h).

// Parses into `message`, which is empty except for memory that was reserved in it.
// Fails with INVALID_ARGUMENT, saying which message was wanted, when the bytes are no such message,
// or naming the field that comes too often. The bytes are let go of in either case.
absl::Status ParseMessage(grpc::ByteBuffer bytes, google::protobuf::Message& message);

grpc::ByteBuffer SerializeMessage(const google::protobuf::Message& message);

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_WIRE_H_

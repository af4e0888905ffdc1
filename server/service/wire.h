#ifndef DUET_SERVER_SERVICE_WIRE_H_
#define DUET_SERVER_SERVICE_WIRE_H_

#include <google/protobuf/message.h>
#include <grpcpp/support/byte_buffer.h>

#include "absl/status/status.h"

namespace duet::server::service {

// Conversion between messages and bytes. The service receives bytes for two reasons: gRPC's
// generated code reports malformed messages as UNIMPLEMENTED, and a request is parsed only after
// its size in memory was bounded (wire_survey.h).

// Parses `bytes` into `message`, which must be empty except for reserved memory. Returns
// INVALID_ARGUMENT with the expected message type if the bytes are malformed, or with the field
// that occurs too often. Frees `bytes` in any case.
absl::Status ParseMessage(grpc::ByteBuffer bytes, google::protobuf::Message& message);

grpc::ByteBuffer SerializeMessage(const google::protobuf::Message& message);

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_WIRE_H_

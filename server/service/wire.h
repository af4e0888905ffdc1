#ifndef DUET_SERVER_SERVICE_WIRE_H_
#define DUET_SERVER_SERVICE_WIRE_H_

#include <google/protobuf/descriptor.h>
#include <google/protobuf/io/zero_copy_stream.h>
#include <google/protobuf/message.h>
#include <grpcpp/support/byte_buffer.h>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "duet/v1/live.pb.h"

namespace duet::server::service {

// Scans the bytes of a message without parsing it, and limits how often each field occurs.
//
// A parsed message can be many times larger than its bytes: an empty submessage has two bytes on
// the wire and about a hundred in memory. The limits are far above those of any valid request,
// which the validator enforces.
//
//   field                         maximum number in the whole message
//   repeated numbers              no limit: they are no larger in memory than on the wire
//   repeated                      65,536; below another repeated field 262,144
//   any other                     1,024, or the limit of the repeated field that contains it
//   unknown, or of another type   1,024 in total
//
// Returns INVALID_ARGUMENT with the field and its limit. Returns OK for malformed bytes, which the
// parser rejects.
absl::Status SurveyMessage(google::protobuf::io::ZeroCopyInputStream& bytes,
                           const google::protobuf::Descriptor& type);

// Conversion between messages and bytes. The service receives bytes for two reasons: gRPC's
// generated code reports malformed messages as UNIMPLEMENTED, and a request is parsed only after
// its size in memory was bounded.

// Parses `bytes` into `message`, which must be empty except for reserved memory. Returns
// INVALID_ARGUMENT with the expected message type if the bytes are malformed, or with the field
// that occurs too often. Frees `bytes` in any case.
absl::Status ParseMessage(grpc::ByteBuffer bytes, google::protobuf::Message& message);

// Parses a message of a live session after the first one. Returns also RESOURCE_EXHAUSTED if it is
// larger than a mebibyte, far above ten seconds of any skeleton at any rate. Frees `bytes`.
absl::StatusOr<v1::SynthesizeLiveRequest> ParseLiveMessage(grpc::ByteBuffer bytes);

grpc::ByteBuffer SerializeMessage(const google::protobuf::Message& message);

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_WIRE_H_

#ifndef DUET_SERVER_SERVICE_WIRE_H_
#define DUET_SERVER_SERVICE_WIRE_H_

#include <google/protobuf/descriptor.h>
#include <google/protobuf/io/zero_copy_stream.h>
#include <google/protobuf/message.h>
#include <grpcpp/support/byte_buffer.h>

#include <cstddef>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "duet/v1/live.pb.h"

namespace duet::server::service {

// Maximum number of values in a request, and in a later message of a live session. Far above those
// of any valid message: 4,096 keyframes with 60 classes each have 500,000.
inline constexpr std::size_t kMaxValues = std::size_t{1} << 19;
inline constexpr std::size_t kMaxLiveValues = std::size_t{1} << 16;

// Scans the bytes of a message without parsing it, and limits the number of its values: texts,
// submessages and unknown fields, at any depth. Numbers do not count, because they are hardly
// larger in memory than on the wire.
//
// A parsed message can be many times larger than its bytes: an empty submessage has two bytes on
// the wire and about a hundred in memory.
//
// Returns INVALID_ARGUMENT with the limit and the field that exceeds it. Returns OK for malformed
// bytes, which the parser rejects.
absl::Status SurveyMessage(google::protobuf::io::ZeroCopyInputStream& bytes,
                           const google::protobuf::Descriptor& type,
                           std::size_t max_values = kMaxValues);

// Conversion between messages and bytes. The service receives bytes for two reasons: gRPC's
// generated code reports malformed messages as UNIMPLEMENTED, and a request is parsed only after
// its size in memory was bounded.

// Parses `bytes` into `message`, which must be empty except for reserved memory. Returns
// INVALID_ARGUMENT with the expected message type if the bytes are malformed, or like
// SurveyMessage. Frees `bytes` in any case.
absl::Status ParseMessage(grpc::ByteBuffer bytes, google::protobuf::Message& message,
                          std::size_t max_values = kMaxValues);

// Parses a message of a live session after the first one. Returns also RESOURCE_EXHAUSTED if it is
// larger than a mebibyte, far above ten seconds of any skeleton at any rate. Frees `bytes`.
absl::StatusOr<v1::SynthesizeLiveRequest> ParseLiveMessage(grpc::ByteBuffer bytes);

grpc::ByteBuffer SerializeMessage(const google::protobuf::Message& message);

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_WIRE_H_

#include "server/service/wire.h"

#include <grpcpp/support/proto_buffer_reader.h>
#include <grpcpp/support/proto_buffer_writer.h>

#include "absl/strings/str_cat.h"
#include "server/service/violations.h"
#include "server/service/wire_survey.h"

namespace duet::server::service {

absl::Status ParseMessage(grpc::ByteBuffer bytes, google::protobuf::Message& message) {
  {
    grpc::ProtoBufferReader reader(&bytes);
    const absl::Status bounded = SurveyMessage(reader, *message.GetDescriptor());
    if (!bounded.ok()) return bounded;
  }
  grpc::ProtoBufferReader reader(&bytes);
  // Parsing proper would clear the message first, and with it what was reserved.
  const int size = static_cast<int>(bytes.Length());
  if (reader.status().ok() && message.MergeFromBoundedZeroCopyStream(&reader, size)) {
    return absl::OkStatus();
  }
  Violations violations;
  violations.Malformed(
      message.GetDescriptor()->full_name(),
      absl::StrCat("is ", bytes.Length(),
                   " bytes that cannot be read: malformed, or a string that is not UTF-8"));
  return violations.ToStatus();
}

grpc::ByteBuffer SerializeMessage(const google::protobuf::Message& message) {
  const int size = static_cast<int>(message.ByteSizeLong());
  grpc::ByteBuffer bytes;
  grpc::ProtoBufferWriter writer(&bytes, grpc::kProtoBufferWriterMaxBufferLength, size);
  message.SerializeToZeroCopyStream(&writer);
  return bytes;
}

}  // namespace duet::server::service

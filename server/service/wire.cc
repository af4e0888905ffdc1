#include "server/service/wire.h"

#include <google/protobuf/io/coded_stream.h>
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
  if (reader.status().ok()) {
    // Not ParseFromZeroCopyStream, which clears the message first, and with it what was reserved;
    // nor MergeFromBoundedZeroCopyStream, which ends the process on an empty message, because
    // gRPC's reader cannot back up before its first slice.
    google::protobuf::io::CodedInputStream stream(&reader);
    if (message.MergeFromCodedStream(&stream) && stream.ConsumedEntireMessage()) {
      return absl::OkStatus();
    }
  }
  Violations violations;
  violations.Malformed(message.GetDescriptor()->full_name(),
                       "a message in wire format with strings in UTF-8",
                       absl::StrCat(bytes.Length(), " bytes that do not parse"));
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

#include "server/service/wire.h"

#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/wire_format.h>
#include <google/protobuf/wire_format_lite.h>
#include <grpcpp/support/proto_buffer_reader.h>
#include <grpcpp/support/proto_buffer_writer.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "server/service/refusals.h"

namespace duet::server::service {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::internal::WireFormat;
using google::protobuf::internal::WireFormatLite;
using google::protobuf::io::CodedInputStream;

constexpr std::size_t kMaxLiveMessageBytes = std::size_t{1} << 20;

// One scan. Stops at the first value too many.
class Surveyor {
 public:
  Surveyor(CodedInputStream& in, std::size_t max_values) : in_(in), max_values_(max_values) {}

  // Returns false if the scan stopped: the bytes are malformed, or refusal() is an error.
  bool Message(const Descriptor& type) {
    const FieldDescriptor* field = nullptr;  // most fields follow another value of the same field
    while (const uint32_t tag = in_.ReadTag()) {
      const int number = WireFormatLite::GetTagFieldNumber(tag);
      if (field == nullptr || field->number() != number) field = type.FindFieldByNumber(number);
      path_.push_back(field);
      if (!Value(field, tag)) return false;
      path_.pop_back();
    }
    return in_.ConsumedEntireMessage();
  }

  const absl::Status& refusal() const { return refusal_; }

 private:
  // `field`: null if it is unknown.
  bool Value(const FieldDescriptor* field, uint32_t tag) {
    const WireFormatLite::WireType wire = WireFormatLite::GetTagWireType(tag);
    const bool has_length = wire == WireFormatLite::WIRETYPE_LENGTH_DELIMITED;
    const bool is_of_type =
        field != nullptr && wire == WireFormat::WireTypeForFieldType(field->type());
    const bool is_number = field != nullptr && FieldDescriptor::IsTypePackable(field->type()) &&
                           (is_of_type || (field->is_repeated() && has_length));
    if (wire == WireFormatLite::WIRETYPE_START_GROUP) {
      refusal_ = Malformed(Path(), "no group, which proto3 does not have", "a group");
      return false;
    }
    if (!is_number && ++values_ > max_values_) {
      refusal_ = Malformed(
          Path(), absl::StrCat("at most ", max_values_, " values in a message, numbers apart"),
          "more");
      return false;
    }
    if (!is_of_type || field->type() != FieldDescriptor::TYPE_MESSAGE) {
      return WireFormatLite::SkipField(&in_, tag);
    }
    uint32_t length = 0;
    if (!in_.ReadVarint32(&length) || length > static_cast<uint32_t>(in_.BytesUntilLimit())) {
      return false;
    }
    const CodedInputStream::Limit outer = in_.PushLimit(static_cast<int>(length));
    const bool seen = Message(*field->message_type());
    in_.PopLimit(outer);
    return seen;
  }

  // Such as "label_keyframes.label_vector"; without unknown fields.
  std::string Path() const {
    std::vector<std::string> names;
    for (const FieldDescriptor* field : path_) {
      if (field != nullptr) names.push_back(field->name());
    }
    return absl::StrJoin(names, ".");
  }

  CodedInputStream& in_;
  const std::size_t max_values_;
  std::size_t values_ = 0;
  std::vector<const FieldDescriptor*> path_;  // of the current value
  absl::Status refusal_;
};

}  // namespace

absl::Status SurveyMessage(google::protobuf::io::ZeroCopyInputStream& bytes, const Descriptor& type,
                           std::size_t max_values) {
  CodedInputStream in(&bytes);
  // Sets a limit, so that every length can be checked against one.
  const CodedInputStream::Limit outer = in.PushLimit(std::numeric_limits<int>::max());
  Surveyor surveyor(in, max_values);
  surveyor.Message(type);
  in.PopLimit(outer);
  return surveyor.refusal();
}

absl::Status ParseMessage(grpc::ByteBuffer bytes, google::protobuf::Message& message,
                          std::size_t max_values) {
  {
    grpc::ProtoBufferReader reader(&bytes);
    const absl::Status bounded = SurveyMessage(reader, *message.GetDescriptor(), max_values);
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
  return Malformed(message.GetDescriptor()->full_name(),
                   "a message in wire format with strings in UTF-8",
                   absl::StrCat(bytes.Length(), " bytes that do not parse"));
}

absl::StatusOr<v1::SynthesizeLiveRequest> ParseLiveMessage(grpc::ByteBuffer bytes) {
  if (bytes.Length() > kMaxLiveMessageBytes) {
    return LiveMessageTooLargeRefusal(bytes.Length(), kMaxLiveMessageBytes);
  }
  v1::SynthesizeLiveRequest message;
  absl::Status parsed = ParseMessage(std::move(bytes), message, kMaxLiveValues);
  if (!parsed.ok()) return parsed;
  return message;
}

grpc::ByteBuffer SerializeMessage(const google::protobuf::Message& message) {
  const int size = static_cast<int>(message.ByteSizeLong());
  grpc::ByteBuffer bytes;
  grpc::ProtoBufferWriter writer(&bytes, grpc::kProtoBufferWriterMaxBufferLength, size);
  message.SerializeToZeroCopyStream(&writer);
  return bytes;
}

}  // namespace duet::server::service

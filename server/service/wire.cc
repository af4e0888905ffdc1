#include "server/service/wire.h"

#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/wire_format.h>
#include <google/protobuf/wire_format_lite.h>
#include <grpcpp/support/proto_buffer_reader.h>
#include <grpcpp/support/proto_buffer_writer.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "server/service/refusals.h"

namespace duet::server::service {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::internal::WireFormat;
using google::protobuf::internal::WireFormatLite;
using google::protobuf::io::CodedInputStream;

constexpr std::size_t kNoLimit = std::numeric_limits<std::size_t>::max();
constexpr std::size_t kMaxOfSingle = 1024;
constexpr std::size_t kMaxOfRepeated = 65536;
constexpr std::size_t kMaxOfNested = 262144;
constexpr std::size_t kMaxUnknown = 1024;
constexpr std::size_t kMaxLiveMessageBytes = std::size_t{1} << 20;

// A field and its path in the message: "label_keyframes.label_vector".
struct Place {
  std::string path;
  const FieldDescriptor* field = nullptr;
  std::size_t limit = 0;
  std::size_t count = 0;
  std::vector<std::unique_ptr<Place>> fields;  // fields of a message found so far

  Place& Field(const FieldDescriptor* wanted, std::size_t limit_of_whole);
};

bool IsNumber(const FieldDescriptor& field) { return field.is_packable(); }

std::size_t LimitOf(const FieldDescriptor& field, std::size_t limit_of_whole) {
  if (!field.is_repeated()) return limit_of_whole;
  if (IsNumber(field)) return kNoLimit;
  return limit_of_whole > kMaxOfSingle ? kMaxOfNested : kMaxOfRepeated;
}

Place& Place::Field(const FieldDescriptor* wanted, std::size_t limit_of_whole) {
  for (const std::unique_ptr<Place>& known : fields) {
    if (known->field == wanted) return *known;
  }
  auto place = std::make_unique<Place>();
  place->path = path.empty() ? wanted->name() : absl::StrCat(path, ".", wanted->name());
  place->field = wanted;
  place->limit = LimitOf(*wanted, limit_of_whole);
  fields.push_back(std::move(place));
  return *fields.back();
}

bool IsOfType(const FieldDescriptor& field, uint32_t tag) {
  const WireFormatLite::WireType wire = WireFormatLite::GetTagWireType(tag);
  return wire == WireFormat::WireTypeForFieldType(field.type()) ||
         (field.is_repeated() && IsNumber(field) &&
          wire == WireFormatLite::WIRETYPE_LENGTH_DELIMITED);
}

// One scan. Stops at the first field that occurs too often.
class Surveyor {
 public:
  explicit Surveyor(CodedInputStream& in) : in_(in) {}

  // Returns false if the scan stopped: the bytes are malformed, or too_many() is an error.
  bool Message(const Descriptor& type, Place& place, std::size_t limit) {
    const Place* last = nullptr;  // most fields follow another value of the same field
    while (const uint32_t tag = in_.ReadTag()) {
      const int number = WireFormatLite::GetTagFieldNumber(tag);
      const FieldDescriptor* field = last != nullptr && last->field->number() == number
                                         ? last->field
                                         : type.FindFieldByNumber(number);
      const bool known = field != nullptr && IsOfType(*field, tag);
      if (!known) {
        if (!Unknown(tag)) return false;
        continue;
      }
      Place& at = place.Field(field, limit);
      last = &at;
      if (!Known(*field, tag, at)) return false;
    }
    return in_.ConsumedEntireMessage();
  }

  const absl::Status& too_many() const { return too_many_; }

 private:
  bool Known(const FieldDescriptor& field, uint32_t tag, Place& place) {
    if (!Count(place.path, place.count, place.limit)) return false;
    if (field.type() != FieldDescriptor::TYPE_MESSAGE) return WireFormatLite::SkipField(&in_, tag);
    uint32_t length = 0;
    if (!in_.ReadVarint32(&length) || length > static_cast<uint32_t>(in_.BytesUntilLimit())) {
      return false;
    }
    const CodedInputStream::Limit outer = in_.PushLimit(static_cast<int>(length));
    const bool seen = Message(*field.message_type(), place, place.limit);
    in_.PopLimit(outer);
    return seen;
  }

  // Each field within a group counts as an unknown field.
  bool Unknown(uint32_t tag) {
    std::size_t open_groups = 0;
    do {
      switch (WireFormatLite::GetTagWireType(tag)) {
        case WireFormatLite::WIRETYPE_START_GROUP:
          ++open_groups;
          break;
        case WireFormatLite::WIRETYPE_END_GROUP:
          if (open_groups == 0) return false;
          --open_groups;
          break;
        default:
          if (!WireFormatLite::SkipField(&in_, tag)) return false;
      }
      if (!Count("", unknown_, kMaxUnknown)) return false;
      if (open_groups > 0) tag = in_.ReadTag();
    } while (open_groups > 0 && tag != 0);
    return open_groups == 0;
  }

  bool Count(const std::string& path, std::size_t& count, std::size_t limit) {
    if (++count <= limit) return true;
    too_many_ =
        path.empty()
            ? Malformed("", absl::StrCat("at most ", limit, " unknown fields"), "more")
            : Malformed(path, absl::StrCat("at most ", limit, " values in a request"), "more");
    return false;
  }

  CodedInputStream& in_;
  std::size_t unknown_ = 0;
  absl::Status too_many_;
};

}  // namespace

absl::Status SurveyMessage(google::protobuf::io::ZeroCopyInputStream& bytes,
                           const Descriptor& type) {
  CodedInputStream in(&bytes);
  // Sets a limit, so that every length can be checked against one.
  const CodedInputStream::Limit outer = in.PushLimit(std::numeric_limits<int>::max());
  Surveyor surveyor(in);
  Place whole;
  surveyor.Message(type, whole, kMaxOfSingle);
  in.PopLimit(outer);
  return surveyor.too_many();
}

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
  return Malformed(message.GetDescriptor()->full_name(),
                   "a message in wire format with strings in UTF-8",
                   absl::StrCat(bytes.Length(), " bytes that do not parse"));
}

absl::StatusOr<v1::SynthesizeLiveRequest> ParseLiveMessage(grpc::ByteBuffer bytes) {
  if (bytes.Length() > kMaxLiveMessageBytes) {
    return LiveMessageTooLargeRefusal(bytes.Length(), kMaxLiveMessageBytes);
  }
  v1::SynthesizeLiveRequest message;
  absl::Status parsed = ParseMessage(std::move(bytes), message);
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

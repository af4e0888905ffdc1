#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

#include "absl/strings/escaping.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/strip.h"
#include "model/base/text.h"
#include "model/formats/gltf/gltf_document.h"
#include "model/motion/motion_limits.h"

namespace duet::formats::gltf {
namespace {

// Limits the values of all accessors: they may share bytes, so a small file could yield many.
constexpr std::size_t kMaxValues = std::size_t{64} << 20;
constexpr int kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123,
              kFloat = 5126;

std::size_t ComponentBytes(const GltfAccessor& accessor) {
  switch (accessor.component_type) {
    case kByte:
    case kUnsignedByte:
      return accessor.normalized ? 1 : 0;
    case kShort:
    case kUnsignedShort:
      return accessor.normalized ? 2 : 0;
    case kFloat:
      return 4;
    default:
      return 0;
  }
}

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "values are copied as they are");

template <typename Written>
float ReadAs(const char* bytes) {
  Written value;
  std::memcpy(&value, bytes, sizeof(value));
  return static_cast<float>(value);
}

float Value(const char* bytes, int component_type) {
  switch (component_type) {
    case kByte:
      return std::max(ReadAs<int8_t>(bytes) / 127, -1.0f);
    case kUnsignedByte:
      return ReadAs<uint8_t>(bytes) / 255;
    case kShort:
      return std::max(ReadAs<int16_t>(bytes) / 32767, -1.0f);
    case kUnsignedShort:
      return ReadAs<uint16_t>(bytes) / 65535;
    default:
      return ReadAs<float>(bytes);
  }
}

// "my%20file.bin" -> my file.bin. A % without a hex number stays: some programs do not escape it.
std::string Unescaped(absl::string_view uri) {
  std::string name;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const absl::string_view digits = uri.substr(i + 1, 2);
    uint8_t byte = 0;
    const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), byte, 16);
    if (uri[i] == '%' && read.ptr == digits.data() + 2) {
      name.push_back(static_cast<char>(byte));
      i += 2;
    } else {
      name.push_back(uri[i]);
    }
  }
  return name;
}

// Whether `name` is a file in the document's folder.
bool IsPlainName(absl::string_view name) {
  return !name.empty() && name != "." && name != ".." &&
         name.find_first_of(absl::string_view("/\\:\0", 4)) == absl::string_view::npos;
}

absl::StatusOr<std::string> DecodeData(absl::string_view uri) {
  const std::size_t comma = uri.find(',');
  std::string bytes;
  if (comma == absl::string_view::npos || !absl::EndsWith(uri.substr(0, comma), ";base64") ||
      !absl::Base64Unescape(uri.substr(comma + 1), &bytes)) {
    return absl::InvalidArgumentError("uri: expected base64 data, got other data");
  }
  return bytes;
}

}  // namespace

absl::StatusOr<std::string> GltfBuffers::Load(const GltfBuffer& buffer) const {
  if (buffer.uri.empty()) {
    if (document_.binary.has_value()) return *document_.binary;
    return absl::InvalidArgumentError("uri: expected one, got none; the file has no binary chunk");
  }
  if (absl::StartsWith(buffer.uri, "data:")) return DecodeData(buffer.uri);
  const std::string name = Unescaped(buffer.uri);
  if (!IsPlainName(name)) {
    return absl::InvalidArgumentError(
        absl::StrCat("uri: expected a file in the same folder, got ", base::Quoted(buffer.uri)));
  }
  absl::StatusOr<std::string> bytes = read_file_(name);
  // The name itself, "100%20.bin", if a program did not escape it.
  if (absl::IsNotFound(bytes.status()) && name != buffer.uri && IsPlainName(buffer.uri)) {
    absl::StatusOr<std::string> unescaped = read_file_(buffer.uri);
    if (unescaped.ok()) return unescaped;
  }
  return bytes;
}

absl::StatusOr<const std::string*> GltfBuffers::Whole(int buffer) {
  auto found = loaded_.find(buffer);
  if (found == loaded_.end()) {
    const GltfBuffer& described = document_.buffers[static_cast<size_t>(buffer)];
    absl::StatusOr<std::string> bytes = Load(described);
    if (bytes.ok() && bytes->size() < described.length) {
      bytes = absl::InvalidArgumentError(absl::StrCat("expected the ", described.length,
                                                      " bytes of byteLength, got ", bytes->size()));
    }
    if (bytes.ok() && described.length > motion::kMaxMotionFileBytes - bytes_loaded_) {
      bytes = absl::InvalidArgumentError(absl::StrCat(
          "expected at most ", motion::kMaxMotionFileBytes, " bytes in all buffers, got more"));
    }
    if (!bytes.ok()) {
      return absl::Status(bytes.status().code(),
                          absl::StrCat("buffers[", buffer, "]: ", bytes.status().message()));
    }
    bytes->resize(described.length);
    bytes_loaded_ += described.length;
    found = loaded_.emplace(buffer, *std::move(bytes)).first;
  }
  return &found->second;
}

absl::StatusOr<std::string> GltfBuffers::ReadItems(const GltfAccessor& accessor,
                                                   const std::string& name, std::size_t width) {
  const GltfView& view = document_.views[static_cast<size_t>(accessor.view)];
  const std::size_t stride = view.stride == 0 ? width : view.stride;
  const absl::StatusOr<const std::string*> buffer = Whole(view.buffer);
  if (!buffer.ok()) return buffer.status();
  // Every number is below 2^32, so 64 bits hold each product.
  const uint64_t end = accessor.count == 0 ? 0
                                           : uint64_t{accessor.offset} +
                                                 uint64_t{accessor.count - 1} * stride + width;
  if (stride < width || end > view.length ||
      uint64_t{view.offset} + view.length > (*buffer)->size()) {
    return absl::InvalidArgumentError(absl::StrCat(
        name, ": expected values within the buffer, got ", accessor.count, " beyond it"));
  }
  std::string bytes;
  bytes.reserve(accessor.count * width);
  for (std::size_t i = 0; i < accessor.count; ++i) {
    bytes.append(**buffer, view.offset + accessor.offset + i * stride, width);
  }
  return bytes;
}

absl::StatusOr<std::vector<float>> GltfBuffers::Read(int index, int components) {
  const std::string name = absl::StrCat("accessors[", index, "]");
  const auto error = [&name](absl::string_view message) {
    return absl::InvalidArgumentError(absl::StrCat(name, ": ", message));
  };
  const GltfAccessor& accessor = document_.accessors[static_cast<size_t>(index)];
  const std::size_t component_bytes = ComponentBytes(accessor);
  if (accessor.components != components || component_bytes == 0) {
    return error(absl::StrCat("expected ", components, " floats or normalized whole numbers, got ",
                              accessor.components, " of type ", accessor.component_type));
  }
  if (accessor.sparse) return error("expected plain values, got sparse ones");
  const std::size_t width = component_bytes * static_cast<std::size_t>(components);
  const std::size_t count = accessor.count * static_cast<std::size_t>(components);
  absl::StatusOr<std::string> bytes = std::string();
  if (accessor.view >= 0) bytes = ReadItems(accessor, name, width);
  if (!bytes.ok()) return bytes.status();
  if (count > kMaxValues - values_read_)
    return error(absl::StrCat("expected at most ", kMaxValues, " values in all, got more"));
  bytes->resize(accessor.count * width);  // zeros if there is no view
  values_read_ += count;
  std::vector<float> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    values[i] = Value(bytes->data() + i * component_bytes, accessor.component_type);
    if (!(std::abs(values[i]) <= static_cast<float>(motion::kMaxCoordinate))) {
      return error(absl::StrCat("value ", i, ": expected a finite number within +-",
                                motion::kMaxCoordinate, ", got ", values[i]));
    }
  }
  return values;
}

}  // namespace duet::formats::gltf

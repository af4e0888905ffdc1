// The subset of the published format that this reader accepts:
//   bytes 0 to 7   header length, unsigned, little-endian; here at most 1 MiB
//   header         JSON: {"name": {"dtype": "F32", "shape": [..], "data_offsets": [begin, end]},
//   ..}
//                  and optionally "__metadata__": {string: string}; padded with spaces
//   data           the tensors' values, row-major, little-endian; offsets count from here
// Every tensor is F32 and has no dimension of size 0. The ranges cover the data from the first to
// the last byte without a gap or an overlap. Every value is finite.

#include "model/checkpoint/safetensors.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/base/status_macros.h"
#include "model/base/strict_json.h"
#include "model/base/text.h"

namespace duet::checkpoint {
namespace {

using nlohmann::json;

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "tensors are copied byte for byte");

constexpr uint64_t kLengthBytes = 8;
constexpr uint64_t kMaxHeaderBytes = 1 << 20;
constexpr uint64_t kAlignment = 8;
constexpr int kMaxHeaderDepth = 3;  // header, tensor, shape
constexpr int64_t kMaxRank = 8;
constexpr char kMetadata[] = "__metadata__";

struct Entry {
  std::string name;
  std::vector<int64_t> shape;
  uint64_t begin = 0;
  uint64_t end = 0;
};

uint64_t ReadLength(std::string_view bytes) {
  uint64_t length = 0;
  std::memcpy(&length, bytes.data(), kLengthBytes);
  return length;
}

absl::StatusOr<std::string_view> HeaderOf(std::string_view bytes) {
  if (bytes.size() < kLengthBytes) {
    return absl::DataLossError(absl::StrCat("safetensors: expected at least ", kLengthBytes,
                                            " bytes, got ", bytes.size()));
  }
  const uint64_t length = ReadLength(bytes);
  if (length > kMaxHeaderBytes) {
    return absl::InvalidArgumentError(absl::StrCat("safetensors header: expected at most ",
                                                   kMaxHeaderBytes, " bytes, got ", length));
  }
  if (length > bytes.size() - kLengthBytes) {
    return absl::DataLossError(absl::StrCat("safetensors header: expected ", length,
                                            " bytes, as declared, got ",
                                            bytes.size() - kLengthBytes));
  }
  return bytes.substr(kLengthBytes, length);
}

// The size of a tensor in bytes, or nothing if it does not fit 64 bits.
bool ByteCount(const std::vector<int64_t>& shape, uint64_t* bytes) {
  *bytes = sizeof(float);
  for (int64_t size : shape) {
    if (__builtin_mul_overflow(*bytes, static_cast<uint64_t>(size), bytes)) return false;
  }
  return true;
}

// Reads a JSON array of whole numbers of at least `min`.
std::vector<int64_t> ReadInts(base::ObjectReader* reader, const std::string& key, int64_t max_count,
                              int64_t min) {
  std::vector<int64_t> numbers;
  for (const json& item : reader->Array(key, static_cast<std::size_t>(max_count))) {
    const bool fits = item.is_number_unsigned() && item.get<uint64_t>() <= INT64_MAX &&
                      item.get<int64_t>() >= min;
    if (!fits) {
      reader->Fail(key, absl::StrCat("expected whole numbers from ", min, " up"));
      return {};
    }
    numbers.push_back(item.get<int64_t>());
  }
  return numbers;
}

absl::StatusOr<Entry> ReadEntry(const std::string& name, const json& value) {
  base::ObjectReader reader(value, absl::StrCat("tensor ", base::Quoted(name)));
  Entry entry;
  entry.name = name;
  if (const std::string dtype = reader.String("dtype", 16); reader.ok() && dtype != "F32") {
    reader.Fail("dtype", absl::StrCat("expected \"F32\", got ", base::Quoted(dtype)));
  }
  entry.shape = ReadInts(&reader, "shape", kMaxRank, 1);
  const std::vector<int64_t> offsets = ReadInts(&reader, "data_offsets", 2, 0);
  DUET_RETURN_IF_ERROR(reader.Finish());
  if (offsets.size() != 2 || offsets[0] > offsets[1]) {
    reader.Fail("data_offsets", "expected a begin and an end that is not before it");
    return reader.Finish();
  }
  entry.begin = static_cast<uint64_t>(offsets[0]);
  entry.end = static_cast<uint64_t>(offsets[1]);
  uint64_t wanted = 0;
  if (!ByteCount(entry.shape, &wanted) || entry.end - entry.begin != wanted) {
    reader.Fail("data_offsets",
                absl::StrCat("expected the bytes of the shape [", absl::StrJoin(entry.shape, ", "),
                             "], got ", entry.end - entry.begin));
    return reader.Finish();
  }
  return entry;
}

absl::Status CheckMetadata(const json& metadata) {
  base::ObjectReader reader(metadata, kMetadata);
  if (metadata.is_object()) {
    for (const auto& field : metadata.items()) reader.String(field.key(), kMaxHeaderBytes);
  }
  return reader.Finish();
}

absl::StatusOr<std::vector<Entry>> ReadHeader(std::string_view header) {
  absl::StatusOr<json> root = base::ParseStrictJson(header, kMaxHeaderDepth);
  if (!root.ok()) {
    return absl::InvalidArgumentError(
        absl::StrCat("safetensors header: ", root.status().message()));
  }
  std::vector<Entry> entries;
  for (const auto& field : root->items()) {
    if (field.key() == kMetadata) {
      DUET_RETURN_IF_ERROR(CheckMetadata(field.value()));
      continue;
    }
    DUET_TRY(entries.emplace_back(), ReadEntry(field.key(), field.value()));
  }
  return entries;
}

// Checks that the ranges are contiguous: no byte of the data is unused or used twice.
absl::Status CheckRanges(const std::vector<Entry>& entries, uint64_t data_bytes) {
  uint64_t at = 0;
  for (const Entry& entry : entries) {
    if (entry.begin != at) {
      return absl::InvalidArgumentError(
          absl::StrCat("tensor ", base::Quoted(entry.name), ".data_offsets: expected a begin at ",
                       at, ", the end of the previous, got ", entry.begin));
    }
    at = entry.end;
  }
  if (at > data_bytes) {
    return absl::DataLossError(
        absl::StrCat("safetensors data: expected ", at, " bytes, as declared, got ", data_bytes));
  }
  if (at < data_bytes) {
    return absl::InvalidArgumentError(absl::StrCat(
        "safetensors data: expected no bytes after the last tensor, got ", data_bytes - at));
  }
  return absl::OkStatus();
}

absl::StatusOr<Tensor> ReadTensor(Entry entry, std::string_view data) {
  Tensor tensor;
  tensor.name = std::move(entry.name);
  tensor.shape = std::move(entry.shape);
  tensor.values.resize((entry.end - entry.begin) / sizeof(float));
  std::memcpy(tensor.values.data(), data.data() + entry.begin, entry.end - entry.begin);
  for (std::size_t i = 0; i < tensor.values.size(); ++i) {
    if (!std::isfinite(tensor.values[i])) {
      return absl::InvalidArgumentError(
          absl::StrCat("tensor ", base::Quoted(tensor.name), ": value ", i,
                       ": expected a finite number, got ", tensor.values[i]));
    }
  }
  return tensor;
}

}  // namespace

absl::StatusOr<std::vector<Tensor>> ParseSafetensors(std::string_view bytes) {
  DUET_TRY(const std::string_view header, HeaderOf(bytes));
  const std::string_view data = bytes.substr(kLengthBytes + header.size());
  DUET_TRY(std::vector<Entry> entries, ReadHeader(header));
  std::sort(entries.begin(), entries.end(),
            [](const Entry& a, const Entry& b) { return a.begin < b.begin; });
  DUET_RETURN_IF_ERROR(CheckRanges(entries, data.size()));
  std::vector<Tensor> tensors;
  for (Entry& entry : entries) {
    DUET_TRY(tensors.emplace_back(), ReadTensor(std::move(entry), data));
  }
  return tensors;
}

std::string SerializeSafetensors(absl::Span<const Tensor> tensors,
                                 const std::map<std::string, std::string>& metadata) {
  nlohmann::ordered_json header = nlohmann::ordered_json::object();
  if (!metadata.empty()) header[kMetadata] = metadata;
  uint64_t at = 0;
  for (const Tensor& tensor : tensors) {
    const uint64_t end = at + tensor.values.size() * sizeof(float);
    header[tensor.name] = {{"dtype", "F32"}, {"shape", tensor.shape}, {"data_offsets", {at, end}}};
    at = end;
  }
  std::string text = header.dump(-1, ' ', true, nlohmann::ordered_json::error_handler_t::replace);
  text.append((kAlignment - text.size() % kAlignment) % kAlignment, ' ');

  const uint64_t length = text.size();
  std::string bytes(kLengthBytes, '\0');
  std::memcpy(bytes.data(), &length, kLengthBytes);
  bytes += text;
  bytes.reserve(bytes.size() + at);
  for (const Tensor& tensor : tensors) {
    bytes.append(reinterpret_cast<const char*>(tensor.values.data()),
                 tensor.values.size() * sizeof(float));
  }
  return bytes;
}

}  // namespace duet::checkpoint

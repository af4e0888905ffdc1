#include "model/formats/flat/npy_array.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"
#include "model/base/text.h"

namespace duet::formats::flat {
namespace {

constexpr absl::string_view kMagic("\x93NUMPY", 6);
// Magic, version and header length end on a multiple of this.
constexpr std::size_t kAlignment = 64;
constexpr std::size_t kMaxHeaderBytes = 4096;

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "values are copied as they are");

absl::Status Error(absl::string_view source, absl::string_view message) {
  return absl::InvalidArgumentError(absl::StrCat(source, ": ", message));
}

// The value of `key` in the header's dictionary: the text up to its comma or closing bracket.
absl::string_view DictValue(absl::string_view dict, absl::string_view key) {
  const std::size_t at = dict.find(absl::StrCat("'", key, "':"));
  if (at == absl::string_view::npos) return {};
  absl::string_view value = absl::StripLeadingAsciiWhitespace(dict.substr(at + key.size() + 3));
  const bool tuple = !value.empty() && value[0] == '(';
  value = value.substr(0, value.find_first_of(tuple ? ")" : ",}"));
  return absl::StripAsciiWhitespace(tuple ? value.substr(1) : value);
}

absl::Status ParseShape(absl::string_view tuple, absl::string_view source,
                        std::vector<int>* shape) {
  for (absl::string_view field : absl::StrSplit(tuple, ',')) {
    if (absl::StripAsciiWhitespace(field).empty()) continue;
    int size = 0;
    if (!base::ParseInteger(field, &size)) {
      return Error(source,
                   absl::StrCat("shape: expected whole numbers, got ", base::Quoted(tuple)));
    }
    shape->push_back(size);
  }
  return absl::OkStatus();
}

template <typename Number>
double Load(const char* bytes) {
  Number value;
  std::memcpy(&value, bytes, sizeof(value));
  return static_cast<double>(value);
}

// The number of values of a shape; false if one of its sizes is negative or the number exceeds
// `most`.
bool CountValues(const std::vector<int>& shape, std::size_t most, std::size_t* count) {
  *count = 1;
  if (std::any_of(shape.begin(), shape.end(), [](int size) { return size < 0; })) return false;
  if (std::count(shape.begin(), shape.end(), 0) > 0) {
    *count = 0;
    return true;
  }
  for (int size : shape) {
    if (*count > most / static_cast<std::size_t>(size)) return false;
    *count *= static_cast<std::size_t>(size);
  }
  return true;
}

}  // namespace

absl::StatusOr<NpyHeader> ParseNpyHeader(absl::string_view bytes, absl::string_view source) {
  if (!absl::ConsumePrefix(&bytes, kMagic) || bytes.size() < 4) {
    return Error(source, "expected a NumPy array, got a file that does not start with \\x93NUMPY");
  }
  const int version = static_cast<unsigned char>(bytes[0]);
  if (version < 1 || version > 3) {
    return Error(source, absl::StrCat("format version: expected 1 to 3, got ", version));
  }
  const std::size_t length_bytes = version == 1 ? 2 : 4;
  if (bytes.size() < 2 + length_bytes) {
    return Error(source, "header: expected its length, got the end of the file");
  }
  uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 2, length_bytes);
  bytes.remove_prefix(2 + length_bytes);
  if (length > kMaxHeaderBytes || length > bytes.size()) {
    return Error(source,
                 absl::StrCat("header: expected at most ", std::min(kMaxHeaderBytes, bytes.size()),
                              " bytes, got ", length));
  }
  const absl::string_view dict = bytes.substr(0, length);
  NpyHeader header;
  header.descr = std::string(DictValue(dict, "descr"));
  header.fortran_order = std::string(DictValue(dict, "fortran_order"));
  header.values = bytes.substr(length);
  absl::Status status = ParseShape(DictValue(dict, "shape"), source, &header.shape);
  if (!status.ok()) return status;
  return header;
}

absl::StatusOr<NpyNumbers> NpyNumbers::Parse(absl::string_view bytes, absl::string_view source) {
  absl::StatusOr<NpyHeader> header = ParseNpyHeader(bytes, source);
  if (!header.ok()) return header.status();
  NpyNumbers numbers;
  numbers.header_ = *std::move(header);
  const std::string& descr = numbers.header_.descr;
  if (descr == "'|O'") {
    return Error(source,
                 "expected an array of numbers, got a pickled Python object; save it as a plain "
                 "array (a sparse matrix: matrix.toarray())");
  }
  const bool known = descr == "'<f4'" || descr == "'<f8'" || descr == "'<i4'" || descr == "'<i8'" ||
                     descr == "'<u4'" || descr == "'<u8'";
  if (!known) {
    return Error(source, absl::StrCat("descr: expected float32, float64 or integers of 4 or 8 "
                                      "bytes, little-endian, got ",
                                      base::Quoted(descr)));
  }
  const std::string& order = numbers.header_.fortran_order;
  if (order != "False" && order != "True") {
    return Error(source,
                 absl::StrCat("fortran_order: expected False or True, got ", base::Quoted(order)));
  }
  numbers.fortran_order_ = order == "True";
  numbers.value_bytes_ = descr[3] == '4' ? 4 : 8;
  const std::size_t held = numbers.header_.values.size() / numbers.value_bytes_;
  if (!CountValues(numbers.header_.shape, held, &numbers.size_) ||
      numbers.size_ * numbers.value_bytes_ != numbers.header_.values.size()) {
    return Error(source, absl::StrCat("expected the values of shape (",
                                      absl::StrJoin(numbers.header_.shape, ", "), "), got ",
                                      numbers.header_.values.size(), " bytes"));
  }
  return numbers;
}

double NpyNumbers::at(std::size_t index) const {
  if (fortran_order_) {
    std::size_t offset = 0, stride = size_;
    for (std::size_t axis = shape().size(); axis > 0; --axis) {
      const std::size_t size = static_cast<std::size_t>(shape()[axis - 1]);
      stride /= size;
      offset += index % size * stride;
      index /= size;
    }
    index = offset;
  }
  const char* bytes = header_.values.data() + index * value_bytes_;
  const char kind = header_.descr[2];
  if (value_bytes_ == 4) {
    if (kind == 'f') return Load<float>(bytes);
    return kind == 'i' ? Load<int32_t>(bytes) : Load<uint32_t>(bytes);
  }
  if (kind == 'f') return Load<double>(bytes);
  return kind == 'i' ? Load<int64_t>(bytes) : Load<uint64_t>(bytes);
}

std::string FormatNpyArray(const std::vector<int>& shape, absl::Span<const float> values) {
  std::string dict = absl::StrCat("{'descr': '<f4', 'fortran_order': False, 'shape': (",
                                  absl::StrJoin(shape, ", "), shape.size() == 1 ? ",), }" : "), }");
  const std::size_t before = kMagic.size() + 4;
  dict.append(kAlignment - (before + dict.size() + 1) % kAlignment, ' ');
  dict.push_back('\n');
  std::string bytes(kMagic);
  bytes.append(
      {'\x01', '\x00', static_cast<char>(dict.size() & 0xff), static_cast<char>(dict.size() >> 8)});
  bytes += dict;
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
  return bytes;
}

}  // namespace duet::formats::flat

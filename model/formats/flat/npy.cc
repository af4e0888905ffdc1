#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"
#include "absl/types/span.h"
#include "model/base/text.h"
#include "model/formats/flat/flat_files.h"
#include "model/motion/motion_limits.h"

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

// The values of an array, as the header describes them.
struct NpyArray {
  std::size_t value_bytes = 0;  // 4 or 8
  std::vector<int> shape;
  absl::string_view values;  // refers to the parsed bytes
};

absl::StatusOr<NpyArray> ParseHeader(absl::string_view bytes, absl::string_view source) {
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
  NpyArray array;
  array.values = bytes.substr(length);
  absl::Status status = ParseShape(DictValue(dict, "shape"), source, &array.shape);
  if (!status.ok()) return status;
  const absl::string_view descr = DictValue(dict, "descr");
  if (descr != "'<f4'" && descr != "'<f8'") {
    return Error(
        source,
        absl::StrCat("descr: expected '<f4' or '<f8' (float32 or float64, little-endian), got ",
                     base::Quoted(descr)));
  }
  array.value_bytes = descr == "'<f4'" ? 4 : 8;
  const absl::string_view order = DictValue(dict, "fortran_order");
  if (order == "False") return array;
  return Error(source,
               absl::StrCat("fortran_order: expected False (C order), got ", base::Quoted(order)));
}

// Whether the array has positions of so many joints, and all of them.
absl::Status CheckShape(const NpyArray& array, int joints, absl::string_view source) {
  const std::vector<int>& shape = array.shape;
  const std::size_t rank = shape.size();
  const bool people = rank == 4 && (shape[0] == 1 || shape[0] == 2);
  if ((rank != 3 && !people) || shape[rank - 1] != 3 || shape[rank - 2] != joints ||
      shape[rank - 3] < 1 || shape[rank - 3] > motion::kMaxMotionFrames) {
    return Error(source, absl::StrCat("shape: expected (frames, ", joints, ", 3) or (2, frames, ",
                                      joints, ", 3) with 1 to ", motion::kMaxMotionFrames,
                                      " frames, got (", absl::StrJoin(shape, ", "), ")"));
  }
  std::size_t expected = array.value_bytes;
  for (int size : shape) expected *= static_cast<std::size_t>(size);
  if (array.values.size() == expected) return absl::OkStatus();
  return Error(source,
               absl::StrCat("expected ", expected, " bytes of values, got ", array.values.size()));
}

double TakeValue(NpyArray* array) {
  double value = 0;
  if (array->value_bytes == 4) {
    float single = 0;
    std::memcpy(&single, array->values.data(), sizeof(single));
    value = static_cast<double>(single);
  } else {
    std::memcpy(&value, array->values.data(), sizeof(value));
  }
  array->values.remove_prefix(array->value_bytes);
  return value;
}

absl::Status ReadPositions(absl::string_view source, NpyArray* array, motion::Clip* person) {
  const std::size_t joints = person->joint_names.size();
  for (std::size_t i = 0; i < person->poses.all().size(); ++i) {
    motion::Vec3& position = person->poses.all()[i];
    for (float* axis : {&position.x, &position.y, &position.z}) {
      const double value = TakeValue(array);
      if (!(std::abs(value) <= motion::kMaxCoordinate)) {
        return Error(source,
                     absl::StrCat("frame ", i / joints, " ", person->joint_names[i % joints],
                                  ": expected a finite position, got ", value));
      }
      *axis = static_cast<float>(value);
    }
  }
  return absl::OkStatus();
}

// float32 in C order. Requires as many values as the shape says.
std::string FormatNpyArray(const std::vector<int>& shape, absl::Span<const float> values) {
  std::string dict = absl::StrCat("{'descr': '<f4', 'fortran_order': False, 'shape': (",
                                  absl::StrJoin(shape, ", "), "), }");
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

}  // namespace

absl::StatusOr<motion::RecordedMotion> ParseNpy(absl::string_view bytes, absl::string_view source,
                                                const std::vector<std::string>& joint_names) {
  absl::StatusOr<NpyArray> array = ParseHeader(bytes, source);
  if (!array.ok()) return array.status();
  const int joints = static_cast<int>(joint_names.size());
  absl::Status status = CheckShape(*array, joints, source);
  if (!status.ok()) return status;
  const std::vector<int>& shape = array->shape;
  motion::RecordedMotion motion;
  motion.people.resize(shape.size() == 4 ? static_cast<std::size_t>(shape[0]) : 1);
  for (motion::Clip& person : motion.people) {
    person.joint_names = joint_names;
    person.poses = motion::Poses(shape[shape.size() - 3], joints);
    status = ReadPositions(source, &*array, &person);
    if (!status.ok()) return status;
  }
  return motion;
}

std::string FormatNpy(const std::vector<motion::Clip>& people) {
  std::vector<motion::Vec3> all;
  for (const motion::Clip& person : people) {
    all.insert(all.end(), person.poses.all().begin(), person.poses.all().end());
  }
  std::vector<int> shape = {people[0].frame_count(), people[0].joint_count(), 3};
  if (people.size() > 1) shape.insert(shape.begin(), 2);
  return FormatNpyArray(shape, {reinterpret_cast<const float*>(all.data()), 3 * all.size()});
}

}  // namespace duet::formats::flat

#include "model/formats/flat/npy.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"
#include "model/base/text.h"
#include "model/motion/motion_limits.h"

namespace duet::formats::flat {
namespace {

constexpr absl::string_view kMagic("\x93NUMPY", 6);
// Magic, version and header length end on a multiple of this.
constexpr std::size_t kAlignment = 64;
constexpr std::size_t kMaxHeaderBytes = 4096;

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "values are copied as they are");

struct Header {
  std::string descr;
  std::string fortran_order;
  std::vector<int> shape;
};

// The value of `key` in the header's dictionary: the text up to its comma or closing bracket.
absl::string_view DictValue(absl::string_view dict, absl::string_view key) {
  const std::size_t at = dict.find(absl::StrCat("'", key, "':"));
  if (at == absl::string_view::npos) return {};
  absl::string_view value = absl::StripLeadingAsciiWhitespace(dict.substr(at + key.size() + 3));
  const bool tuple = !value.empty() && value[0] == '(';
  value = value.substr(0, value.find_first_of(tuple ? ")" : ",}"));
  return absl::StripAsciiWhitespace(tuple ? value.substr(1) : value);
}

class NpyParser {
 public:
  NpyParser(absl::string_view bytes, absl::string_view source) : bytes_(bytes), source_(source) {}

  absl::StatusOr<motion::RecordedMotion> Parse(const std::vector<std::string>& joint_names) {
    absl::Status status = ParseHeader();
    if (status.ok()) status = CheckHeader(static_cast<int>(joint_names.size()));
    if (!status.ok()) return status;
    motion::RecordedMotion motion;
    const int frames = header_.shape[header_.shape.size() - 3];
    motion.people.resize(header_.shape.size() == 4 ? static_cast<size_t>(header_.shape[0]) : 1);
    for (motion::Clip& person : motion.people) {
      person.joint_names = joint_names;
      person.poses = motion::Poses(frames, static_cast<int>(joint_names.size()));
      status = ReadPositions(&person);
      if (!status.ok()) return status;
    }
    return motion;
  }

 private:
  absl::Status Error(absl::string_view message) const {
    return absl::InvalidArgumentError(absl::StrCat(source_, ": ", message));
  }

  absl::Status ParseHeader() {
    if (!absl::ConsumePrefix(&bytes_, kMagic) || bytes_.size() < 4) {
      return Error("expected a NumPy array, got a file that does not start with \\x93NUMPY");
    }
    const int version = static_cast<unsigned char>(bytes_[0]);
    if (version < 1 || version > 3) {
      return Error(absl::StrCat("format version: expected 1 to 3, got ", version));
    }
    const std::size_t length_bytes = version == 1 ? 2 : 4;
    if (bytes_.size() < 2 + length_bytes)
      return Error("header: expected its length, got the end of the file");
    uint32_t length = 0;
    std::memcpy(&length, bytes_.data() + 2, length_bytes);
    bytes_.remove_prefix(2 + length_bytes);
    if (length > kMaxHeaderBytes || length > bytes_.size()) {
      return Error(absl::StrCat("header: expected at most ",
                                std::min(kMaxHeaderBytes, bytes_.size()), " bytes, got ", length));
    }
    const absl::string_view dict = bytes_.substr(0, length);
    bytes_.remove_prefix(length);
    header_.descr = std::string(DictValue(dict, "descr"));
    header_.fortran_order = std::string(DictValue(dict, "fortran_order"));
    return ParseShape(DictValue(dict, "shape"));
  }

  absl::Status ParseShape(absl::string_view tuple) {
    for (absl::string_view field : absl::StrSplit(tuple, ',')) {
      if (absl::StripAsciiWhitespace(field).empty()) continue;
      int size = 0;
      if (!base::ParseInteger(field, &size)) {
        return Error(absl::StrCat("shape: expected whole numbers, got ", base::Quoted(tuple)));
      }
      header_.shape.push_back(size);
    }
    return absl::OkStatus();
  }

  absl::Status CheckHeader(int joints) const {
    if (header_.descr != "'<f4'" && header_.descr != "'<f8'") {
      return Error(
          absl::StrCat("descr: expected '<f4' or '<f8' (float32 or float64, little-endian), got ",
                       base::Quoted(header_.descr)));
    }
    if (header_.fortran_order != "False") {
      return Error(absl::StrCat("fortran_order: expected False (C order), got ",
                                base::Quoted(header_.fortran_order)));
    }
    const std::vector<int>& shape = header_.shape;
    const std::size_t rank = shape.size();
    const bool people = rank == 4 && (shape[0] == 1 || shape[0] == 2);
    if ((rank != 3 && !people) || shape[rank - 1] != 3 || shape[rank - 2] != joints ||
        shape[rank - 3] < 1 || shape[rank - 3] > motion::kMaxMotionFrames) {
      return Error(absl::StrCat("shape: expected (frames, ", joints, ", 3) or (2, frames, ", joints,
                                ", 3) with 1 to ", motion::kMaxMotionFrames, " frames, got (",
                                absl::StrJoin(shape, ", "), ")"));
    }
    std::size_t expected = ValueBytes();
    for (int size : shape) expected *= static_cast<std::size_t>(size);
    if (bytes_.size() == expected) return absl::OkStatus();
    return Error(absl::StrCat("expected ", expected, " bytes of values, got ", bytes_.size()));
  }

  std::size_t ValueBytes() const { return header_.descr == "'<f4'" ? 4 : 8; }

  double TakeValue() {
    double value = 0;
    if (ValueBytes() == 4) {
      float single = 0;
      std::memcpy(&single, bytes_.data(), sizeof(single));
      value = static_cast<double>(single);
    } else {
      std::memcpy(&value, bytes_.data(), sizeof(value));
    }
    bytes_.remove_prefix(ValueBytes());
    return value;
  }

  absl::Status ReadPositions(motion::Clip* person) {
    for (std::size_t i = 0; i < person->poses.all().size(); ++i) {
      motion::Vec3& position = person->poses.all()[i];
      for (float* axis : {&position.x, &position.y, &position.z}) {
        const double value = TakeValue();
        if (!(std::abs(value) <= motion::kMaxCoordinate)) {
          const std::size_t joints = person->joint_names.size();
          return Error(absl::StrCat("frame ", i / joints, " ", person->joint_names[i % joints],
                                    ": expected a finite position, got ", value));
        }
        *axis = static_cast<float>(value);
      }
    }
    return absl::OkStatus();
  }

  absl::string_view bytes_;
  absl::string_view source_;
  Header header_;
};

void AppendPositions(const motion::Clip& clip, std::string* out) {
  out->append(reinterpret_cast<const char*>(clip.poses.all().data()),
              clip.poses.all().size() * sizeof(motion::Vec3));
}

// Formats everything before the values. `people` is the text of the first dimension.
std::string FormatHeader(absl::string_view people, const motion::Clip& clip) {
  std::string dict = absl::StrCat("{'descr': '<f4', 'fortran_order': False, 'shape': (", people,
                                  clip.frame_count(), ", ", clip.joint_count(), ", 3), }");
  const std::size_t before = kMagic.size() + 4;
  dict.append(kAlignment - (before + dict.size() + 1) % kAlignment, ' ');
  dict.push_back('\n');
  std::string bytes(kMagic);
  bytes.append(
      {'\x01', '\x00', static_cast<char>(dict.size() & 0xff), static_cast<char>(dict.size() >> 8)});
  bytes += dict;
  return bytes;
}

}  // namespace

absl::StatusOr<motion::RecordedMotion> ParseNpy(absl::string_view bytes, absl::string_view source,
                                                const std::vector<std::string>& joint_names) {
  return NpyParser(bytes, source).Parse(joint_names);
}

std::string FormatNpy(const motion::ClipPair& pair) {
  std::string bytes = FormatHeader("2, ", pair.leader);
  AppendPositions(pair.leader, &bytes);
  AppendPositions(pair.follower, &bytes);
  return bytes;
}

std::string FormatNpy(const motion::Clip& person) {
  std::string bytes = FormatHeader("", person);
  AppendPositions(person, &bytes);
  return bytes;
}

}  // namespace duet::formats::flat

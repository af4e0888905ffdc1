#include "model/formats/flat/npy.h"

#include <cmath>
#include <cstring>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/types/span.h"
#include "model/base/text.h"
#include "model/formats/flat/npy_array.h"
#include "model/motion/motion_limits.h"

namespace duet::formats::flat {
namespace {

class NpyParser {
 public:
  NpyParser(NpyHeader header, absl::string_view source)
      : bytes_(header.values), source_(source), header_(std::move(header)) {}

  absl::StatusOr<motion::RecordedMotion> Parse(const std::vector<std::string>& joint_names) {
    absl::Status status = CheckHeader(static_cast<int>(joint_names.size()));
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
  NpyHeader header_;
};

// The positions of all frames and joints, one after the other.
absl::Span<const float> Values(absl::Span<const motion::Vec3> positions) {
  return {reinterpret_cast<const float*>(positions.data()), 3 * positions.size()};
}

}  // namespace

absl::StatusOr<motion::RecordedMotion> ParseNpy(absl::string_view bytes, absl::string_view source,
                                                const std::vector<std::string>& joint_names) {
  absl::StatusOr<NpyHeader> header = ParseNpyHeader(bytes, source);
  if (!header.ok()) return header.status();
  return NpyParser(*std::move(header), source).Parse(joint_names);
}

std::string FormatNpy(const motion::ClipPair& pair) {
  std::vector<motion::Vec3> both(pair.leader.poses.all().begin(), pair.leader.poses.all().end());
  both.insert(both.end(), pair.follower.poses.all().begin(), pair.follower.poses.all().end());
  return FormatNpyArray({2, pair.leader.frame_count(), pair.leader.joint_count(), 3}, Values(both));
}

std::string FormatNpy(const motion::Clip& person) {
  return FormatNpyArray({person.frame_count(), person.joint_count(), 3},
                        Values(person.poses.all()));
}

}  // namespace duet::formats::flat

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "model/base/median.h"
#include "model/base/text.h"
#include "server/service/request_fields.h"

namespace duet::server::service {
namespace {

// Half of an adult's joints are about 0.4 m from the middle, a baby's 0.1 m. Centimetres declared
// as metres give 40 m, metres declared as millimetres 0.0004 m.
constexpr float kSmallestMetres = 0.05f;
constexpr float kLargestMetres = 4;
// Enough to outvote frames without a person, and few enough for ten minutes at 240 Hz.
constexpr int kFrames = 31;

// Median distance of the joints from their middle.
float SizeOf(absl::Span<const motion::Vec3> pose) {
  std::vector<float> x, y, z, distances;
  for (const motion::Vec3& joint : pose) {
    x.push_back(joint.x);
    y.push_back(joint.y);
    z.push_back(joint.z);
  }
  const motion::Vec3 middle = {base::Median(std::move(x)), base::Median(std::move(y)),
                               base::Median(std::move(z))};
  distances.reserve(pose.size());
  for (const motion::Vec3& joint : pose) distances.push_back(Norm(joint - middle));
  return base::Median(std::move(distances));
}

// A clip in which nobody was ever captured. It needs every frame: those with a person may be few.
bool ShowsNobody(const motion::Poses& poses) {
  for (int frame = 0; frame < poses.frame_count(); ++frame) {
    if (!IsPoint(poses[frame])) return false;
  }
  return poses.joint_count() > 1;
}

// Maximum number of invalid values that are listed individually.
constexpr int kNamedValues = 3;

std::string At(absl::string_view field, int index) { return absl::StrCat(field, "[", index, "]"); }

std::string EnumValue(const std::string& name, int number) {
  return name.empty() ? absl::StrCat(number) : name;
}

std::optional<motion::LengthUnit> ToUnit(v1::LengthUnit unit) {
  switch (unit) {
    case v1::LENGTH_UNIT_METRES:
      return motion::LengthUnit::kMetres;
    case v1::LENGTH_UNIT_MILLIMETRES:
      return motion::LengthUnit::kMillimetres;
    case v1::LENGTH_UNIT_SBU_NORMALISED:
      return motion::LengthUnit::kSbuNormalised;
    default:
      return std::nullopt;
  }
}

std::optional<motion::UpAxis> ToUpAxis(v1::UpAxis axis) {
  switch (axis) {
    case v1::UP_AXIS_Y_UP:
      return motion::UpAxis::kYUp;
    case v1::UP_AXIS_Z_UP:
      return motion::UpAxis::kZUp;
    case v1::UP_AXIS_Y_DOWN:
      return motion::UpAxis::kYDown;
    default:
      return std::nullopt;
  }
}

// " (head, neck, ...)".
std::string NamesOf(const engine::ModelDescription& model) {
  return absl::StrCat(" (", absl::StrJoin(model.skeleton.joint_names, ", "), ")");
}

void NameMissingJoints(const engine::ModelDescription& model, const std::vector<int>& first_use,
                       Violations& violations) {
  std::vector<std::string> missing;
  for (int joint = 0; joint < model.skeleton.joint_count(); ++joint) {
    if (first_use[joint] < 0) missing.push_back(model.skeleton.joint_names[joint]);
  }
  if (missing.empty()) return;
  violations.Mismatch(
      "leader.joint_names",
      absl::StrCat("all ", model.skeleton.joint_count(), " joints of model ", model.name),
      absl::StrCat("none for ", absl::StrJoin(missing, ", ")));
}

}  // namespace

bool IsPoint(absl::Span<const motion::Vec3> pose) {
  return std::all_of(pose.begin(), pose.end(),
                     [&pose](const motion::Vec3& joint) { return joint == pose.front(); });
}

void ValidateSize(absl::string_view field, const motion::Poses& poses, Violations& violations) {
  const int frames = poses.frame_count();
  if (frames == 0) return;
  const int samples = std::min(frames, kFrames);
  std::vector<float> sizes;
  for (int i = 0; i < samples; ++i) {
    const int frame = static_cast<int>(static_cast<long>(frames) * i / samples);
    sizes.push_back(SizeOf(poses[frame]));
  }
  const float size = base::Median(std::move(sizes));
  const bool nobody = size == 0 && ShowsNobody(poses);
  if (!nobody && (size == 0 || (size >= kSmallestMetres && size <= kLargestMetres))) return;
  violations.Malformed(std::string(field),
                       absl::StrCat("the size of a person (half of the joints ", kSmallestMetres,
                                    " to ", kLargestMetres, " m from the middle)"),
                       nobody ? "all joints in one point in every frame"
                              : absl::StrFormat("%.3g m; check leader.unit (convert centimetres to "
                                                "millimetres)",
                                                size));
}

std::optional<motion::Coordinates> ValidateCoordinates(const v1::Motion& leader,
                                                       Violations& violations) {
  const std::optional<motion::LengthUnit> unit = ToUnit(leader.unit());
  const std::optional<motion::UpAxis> up_axis = ToUpAxis(leader.up_axis());
  if (!unit.has_value()) {
    violations.Malformed(
        "leader.unit", "LENGTH_UNIT_METRES, LENGTH_UNIT_MILLIMETRES or LENGTH_UNIT_SBU_NORMALISED",
        EnumValue(v1::LengthUnit_Name(leader.unit()), leader.unit()));
  }
  if (!up_axis.has_value()) {
    violations.Malformed("leader.up_axis", "UP_AXIS_Y_UP, UP_AXIS_Z_UP or UP_AXIS_Y_DOWN",
                         EnumValue(v1::UpAxis_Name(leader.up_axis()), leader.up_axis()));
  }
  if (!unit.has_value() || !up_axis.has_value()) return std::nullopt;
  if (*unit == motion::LengthUnit::kSbuNormalised && *up_axis != motion::UpAxis::kYDown) {
    violations.Malformed("leader.up_axis", "UP_AXIS_Y_DOWN with LENGTH_UNIT_SBU_NORMALISED",
                         v1::UpAxis_Name(leader.up_axis()));
    return std::nullopt;
  }
  return motion::Coordinates{*unit, *up_axis};
}

std::vector<int> ValidateJoints(const v1::Motion& leader, const engine::ModelDescription& model,
                                Violations& violations) {
  const int count = leader.joint_names_size();
  if (count > kMaxJointNames) {
    violations.Mismatch(
        "leader.joint_names",
        absl::StrCat("the ", model.skeleton.joint_count(), " joints of model ", model.name),
        absl::StrCat(count, " names"));
    return {};
  }
  std::vector<int> joints;
  std::vector<int> first_use(model.skeleton.joint_names.size(), -1);
  bool fits = true, listed = false;
  for (int i = 0; i < count; ++i) {
    const std::string& name = leader.joint_names(i);
    const int joint = model.skeleton.Find(name);
    joints.push_back(joint);
    if (joint < 0) {
      violations.Mismatch(At("leader.joint_names", i),
                          absl::StrCat("a joint of model ", model.name,
                                       std::exchange(listed, true) ? "" : NamesOf(model)),
                          base::Quoted(name));
    } else if (first_use[joint] >= 0) {
      violations.Mismatch(
          At("leader.joint_names", i), "each joint once",
          absl::StrCat(base::Quoted(name), " again after joint_names[", first_use[joint], "]"));
    } else {
      first_use[joint] = i;
      continue;
    }
    fits = false;
  }
  NameMissingJoints(model, first_use, violations);
  if (!fits || count != model.skeleton.joint_count()) return {};
  return joints;
}

void ValidateTiming(const v1::Motion& leader, const RequestLimits& limits, Violations& violations) {
  const double rate = leader.frame_rate_hz();
  const bool rate_fits = rate >= limits.min_frame_rate_hz && rate <= limits.max_frame_rate_hz;
  if (!rate_fits) {
    violations.Malformed("leader.frame_rate_hz",
                         absl::StrCat(limits.min_frame_rate_hz, " to ", limits.max_frame_rate_hz,
                                      " frames per second"),
                         base::NumberText(rate));
  }
  const uint32_t frames = leader.frame_count();
  if (frames < static_cast<uint32_t>(limits.min_frames)) {
    violations.Malformed("leader.frame_count", absl::StrCat("at least ", limits.min_frames),
                         absl::StrCat(frames));
  } else if (rate_fits && frames > limits.max_duration_seconds * rate) {
    violations.Malformed("leader.frame_count",
                         absl::StrCat("a duration of at most ", limits.max_duration_seconds, " s"),
                         absl::StrCat(frames, " frames, ", frames / rate, " s at ",
                                      base::NumberText(rate), " frames per second"));
  }
}

bool ValidateCount(absl::string_view field, int values, std::optional<uint32_t> frames, int joints,
                   Violations& violations) {
  const uint64_t expected = uint64_t{frames.value_or(1)} * static_cast<uint64_t>(joints) * 3;
  if (static_cast<uint64_t>(values) == expected) return true;
  violations.Malformed(std::string(field),
                       absl::StrCat(expected, " values (",
                                    frames.has_value() ? absl::StrCat(*frames, " frames x ") : "",
                                    joints, " joints x 3)"),
                       absl::StrCat(values));
  return false;
}

bool ValidateFinite(absl::string_view field,
                    const google::protobuf::RepeatedField<float>& positions,
                    Violations& violations) {
  int found = 0;
  for (int i = 0; i < positions.size(); ++i) {
    if (std::isfinite(positions[i])) continue;
    if (++found <= kNamedValues) {
      violations.Malformed(At(field, i), "a finite number", absl::StrCat(positions[i]));
    }
  }
  if (found > kNamedValues) {
    violations.Malformed(
        std::string(field), "finite numbers",
        absl::StrCat(found, " of ", positions.size(), " values that are not finite"));
  }
  return found == 0;
}

motion::Poses ReadPositions(absl::string_view field,
                            const google::protobuf::RepeatedField<float>& positions,
                            const std::vector<int>& joints, const motion::Coordinates& coordinates,
                            const RequestLimits& limits, Violations& violations) {
  const int points = positions.size() / 3;
  const int joint_count = static_cast<int>(joints.size());
  const float limit = limits.max_abs_coordinate_metres;
  motion::Poses world(points / joint_count, joint_count);
  int too_far = 0;
  for (int point = 0; point < points; ++point) {
    const float* xyz = positions.data() + 3 * static_cast<std::ptrdiff_t>(point);
    const motion::Vec3 position = ToWorld(coordinates, {xyz[0], xyz[1], xyz[2]});
    world.at(point / joint_count, joints[point % joint_count]) = position;
    // Negated, so that a conversion that overflowed is rejected too.
    if (std::abs(position.x) <= limit && std::abs(position.y) <= limit &&
        std::abs(position.z) <= limit) {
      continue;
    }
    if (++too_far <= kNamedValues) {
      violations.Malformed(
          absl::StrCat(field, "[", 3 * point, "..", 3 * point + 2, "]"),
          absl::StrCat("at most ", limit, " m from the origin along each axis"),
          absl::StrCat("(", xyz[0], ", ", xyz[1], ", ", xyz[2], "); check leader.unit"));
    }
  }
  if (too_far > kNamedValues) {
    violations.Malformed(std::string(field),
                         absl::StrCat("at most ", limit, " m from the origin along each axis"),
                         absl::StrCat(too_far, " positions farther away"));
  }
  return too_far > 0 ? motion::Poses() : world;
}

}  // namespace duet::server::service

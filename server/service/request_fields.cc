#include "server/service/request_fields.h"

#include <algorithm>
#include <cstddef>

#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "model/base/median.h"

namespace duet::server::service {
namespace {

using absl::StrCat;

// Half of an adult's joints are about 0.4 m from the middle, a baby's 0.1 m. Centimetres declared
// as metres give 40 m, metres declared as millimetres 0.0004 m.
constexpr float kSmallestMetres = 0.05f;
constexpr float kLargestMetres = 4;
// Enough to outvote frames without a person, and few enough for ten minutes at 240 Hz.
constexpr int kFrames = 31;
// Maximum number of invalid values that are listed individually.
constexpr int kNamedValues = 3;
// A label vector with more than this many weights beyond the number of classes is rejected as a
// whole.
constexpr int kMaxExtraWeights = 64;

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

std::string EnumValue(const std::string& name, int number) {
  return name.empty() ? StrCat(number) : name;
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

}  // namespace

bool IsPoint(absl::Span<const motion::Vec3> pose) {
  return std::all_of(pose.begin(), pose.end(),
                     [&pose](const motion::Vec3& joint) { return joint == pose.front(); });
}

bool RequestFields::AtMost(absl::string_view field, int most, int count) {
  if (count <= most) return true;
  violations_.Malformed(field, StrCat("at most ", most), StrCat(count));
  return false;
}

bool RequestFields::Whole(absl::string_view field, uint32_t value, int min, int max,
                          absl::string_view hint) {
  if (value >= static_cast<uint32_t>(min) && value <= static_cast<uint32_t>(max)) return true;
  violations_.Malformed(field, StrCat(min, " to ", max, hint), StrCat(value));
  return false;
}

void RequestFields::Number(absl::string_view field, float value, float min, float max) {
  // False for NaN.
  if (value >= min && value <= max) return;
  violations_.Malformed(field, StrCat("a finite value in [", min, ", ", max, "]"),
                        base::NumberText(value));
}

bool RequestFields::Finite(absl::string_view field,
                           const google::protobuf::RepeatedField<float>& values) {
  int found = 0;
  for (int i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i])) continue;
    if (++found > kNamedValues) continue;
    violations_.Malformed(StrCat(field, "[", i, "]"), "a finite number", StrCat(values[i]));
  }
  if (found > kNamedValues) {
    violations_.Malformed(field, "finite numbers",
                          StrCat(found, " of ", values.size(), " values that are not finite"));
  }
  return found == 0;
}

std::optional<motion::Coordinates> RequestFields::Coordinates(const v1::Motion& leader) {
  const std::optional<motion::LengthUnit> unit = ToUnit(leader.unit());
  const std::optional<motion::UpAxis> up_axis = ToUpAxis(leader.up_axis());
  if (!unit.has_value()) {
    violations_.Malformed(
        "leader.unit", "LENGTH_UNIT_METRES, LENGTH_UNIT_MILLIMETRES or LENGTH_UNIT_SBU_NORMALISED",
        EnumValue(v1::LengthUnit_Name(leader.unit()), leader.unit()));
  }
  if (!up_axis.has_value()) {
    violations_.Malformed("leader.up_axis", "UP_AXIS_Y_UP, UP_AXIS_Z_UP or UP_AXIS_Y_DOWN",
                          EnumValue(v1::UpAxis_Name(leader.up_axis()), leader.up_axis()));
  }
  if (!unit.has_value() || !up_axis.has_value()) return std::nullopt;
  if (*unit == motion::LengthUnit::kSbuNormalised && *up_axis != motion::UpAxis::kYDown) {
    violations_.Malformed("leader.up_axis", "UP_AXIS_Y_DOWN with LENGTH_UNIT_SBU_NORMALISED",
                          v1::UpAxis_Name(leader.up_axis()));
    return std::nullopt;
  }
  return motion::Coordinates{*unit, *up_axis};
}

std::vector<int> RequestFields::Joints(const v1::Motion& leader) {
  constexpr char kField[] = "leader.joint_names";
  const std::vector<std::string>& names = model_.skeleton.joint_names;
  const int count = leader.joint_names_size();
  if (count > kMaxJointNames) {
    violations_.Mismatch(kField, StrCat("the ", names.size(), " joints of model ", model_.name),
                         StrCat(count, " names"));
    return {};
  }
  std::vector<int> joints;
  std::vector<int> first_use(names.size(), -1);
  bool fits = true, listed = false;
  for (int i = 0; i < count; ++i) {
    const std::string at = StrCat(kField, "[", i, "]");
    const std::string& name = leader.joint_names(i);
    const int joint = model_.skeleton.Find(name);
    joints.push_back(joint);
    if (joint >= 0 && first_use[joint] < 0) {
      first_use[joint] = i;
      continue;
    }
    fits = false;
    if (joint >= 0) {
      violations_.Mismatch(
          at, "each joint once",
          StrCat(base::Quoted(name), " again after joint_names[", first_use[joint], "]"));
      continue;
    }
    const std::string all = StrCat(" (", absl::StrJoin(names, ", "), ")");
    violations_.Mismatch(
        at, StrCat("a joint of model ", model_.name, std::exchange(listed, true) ? "" : all),
        base::Quoted(name));
  }
  std::vector<std::string> missing;
  for (std::size_t joint = 0; joint < names.size(); ++joint) {
    if (first_use[joint] < 0) missing.push_back(names[joint]);
  }
  if (!missing.empty()) {
    violations_.Mismatch(kField, StrCat("all ", names.size(), " joints of model ", model_.name),
                         StrCat("none for ", absl::StrJoin(missing, ", ")));
  }
  return fits && missing.empty() ? joints : std::vector<int>();
}

void RequestFields::Timing(const v1::Motion& leader) {
  const double rate = leader.frame_rate_hz();
  const bool rate_fits = rate >= limits_.min_frame_rate_hz && rate <= limits_.max_frame_rate_hz;
  if (!rate_fits) {
    violations_.Malformed(
        "leader.frame_rate_hz",
        StrCat(limits_.min_frame_rate_hz, " to ", limits_.max_frame_rate_hz, " frames per second"),
        base::NumberText(rate));
  }
  const uint32_t frames = leader.frame_count();
  if (frames < static_cast<uint32_t>(limits_.min_frames)) {
    violations_.Malformed("leader.frame_count", StrCat("at least ", limits_.min_frames),
                          StrCat(frames));
  } else if (rate_fits && frames > limits_.max_duration_seconds * rate) {
    violations_.Malformed("leader.frame_count",
                          StrCat("a duration of at most ", limits_.max_duration_seconds, " s"),
                          StrCat(frames, " frames, ", frames / rate, " s at ",
                                 base::NumberText(rate), " frames per second"));
  }
}

bool RequestFields::Count(absl::string_view field, int values, std::optional<uint32_t> frames,
                          int joints) {
  const uint64_t expected = uint64_t{frames.value_or(1)} * static_cast<uint64_t>(joints) * 3;
  if (static_cast<uint64_t>(values) == expected) return true;
  const std::string of_frames = frames.has_value() ? StrCat(*frames, " frames x ") : "";
  violations_.Malformed(field, StrCat(expected, " values (", of_frames, joints, " joints x 3)"),
                        StrCat(values));
  return false;
}

motion::Poses RequestFields::Positions(absl::string_view field,
                                       const google::protobuf::RepeatedField<float>& values,
                                       std::optional<uint32_t> frames,
                                       const PositionFormat& format) {
  const bool finite = Finite(field, values);
  const bool complete = Count(field, values.size(), frames, format.joint_count);
  if (!finite || !complete || !format.coordinates || format.joints.empty()) return {};
  const int points = values.size() / 3;
  const float limit = limits_.max_abs_coordinate_metres;
  motion::Poses world(points / format.joint_count, format.joint_count);
  int too_far = 0;
  for (int point = 0; point < points; ++point) {
    const float* xyz = values.data() + 3 * static_cast<std::ptrdiff_t>(point);
    const motion::Vec3 position = ToWorld(*format.coordinates, {xyz[0], xyz[1], xyz[2]});
    world.at(point / format.joint_count, format.joints[point % format.joint_count]) = position;
    // Negated, so that a conversion that overflowed is rejected too.
    if (std::abs(position.x) <= limit && std::abs(position.y) <= limit &&
        std::abs(position.z) <= limit) {
      continue;
    }
    if (++too_far > kNamedValues) continue;
    violations_.Malformed(StrCat(field, "[", 3 * point, "..", 3 * point + 2, "]"),
                          StrCat("at most ", limit, " m from the origin along each axis"),
                          StrCat("(", xyz[0], ", ", xyz[1], ", ", xyz[2], "); check leader.unit"));
  }
  if (too_far > kNamedValues) {
    violations_.Malformed(field, StrCat("at most ", limit, " m from the origin along each axis"),
                          StrCat(too_far, " positions farther away"));
  }
  return too_far > 0 ? motion::Poses() : world;
}

void RequestFields::Size(absl::string_view field, const motion::Poses& poses) {
  const int frames = poses.frame_count();
  if (frames == 0) return;
  const int samples = std::min(frames, kFrames);
  std::vector<float> sizes;
  for (int i = 0; i < samples; ++i) {
    sizes.push_back(SizeOf(poses[static_cast<int>(static_cast<long>(frames) * i / samples)]));
  }
  const float size = base::Median(std::move(sizes));
  const bool nobody = size == 0 && ShowsNobody(poses);
  if (!nobody && (size == 0 || (size >= kSmallestMetres && size <= kLargestMetres))) return;
  violations_.Malformed(field,
                        StrCat("the size of a person (half of the joints ", kSmallestMetres, " to ",
                               kLargestMetres, " m from the middle)"),
                        nobody ? "all joints in one point in every frame"
                               : absl::StrFormat("%.3g m; check leader.unit (convert centimetres "
                                                 "to millimetres)",
                                                 size));
}

std::vector<float> RequestFields::LabelVector(absl::string_view field,
                                              const v1::LabelVector& label_vector) {
  std::vector<float> weights(model_.classes.size(), 0.0F);
  std::vector<int> first_use(model_.classes.size(), -1);
  const std::string list = StrCat(field, ".weights");
  const std::string classes = absl::StrJoin(model_.classes, ", ");
  if (label_vector.weights().empty()) {
    violations_.Malformed(list, StrCat("a weight for at least one of ", classes), "none");
  }
  if (label_vector.weights_size() > model_.class_count() + kMaxExtraWeights) {
    violations_.Malformed(
        list, StrCat("at most one weight for each of ", model_.class_count(), " classes"),
        StrCat(label_vector.weights_size(), " weights"));
    return weights;
  }
  for (int i = 0; i < label_vector.weights_size(); ++i) {
    const v1::ClassWeight& entry = label_vector.weights(i);
    const std::string at = StrCat(list, "[", i, "].interaction_class");
    const auto found =
        std::find(model_.classes.begin(), model_.classes.end(), entry.interaction_class());
    const bool known = found != model_.classes.end();
    if (!known) {
      violations_.Malformed(at, StrCat("one of ", classes),
                            base::Quoted(entry.interaction_class()));
    }
    Number(StrCat(list, "[", i, "].weight"), entry.weight(), -limits_.max_abs_weight,
           limits_.max_abs_weight);
    if (!known) continue;
    const auto index = static_cast<std::size_t>(found - model_.classes.begin());
    if (first_use[index] >= 0) {
      violations_.Malformed(at, "each class at most once",
                            StrCat(base::Quoted(entry.interaction_class()), " again after weights[",
                                   first_use[index], "]"));
      continue;
    }
    first_use[index] = i;
    weights[index] = entry.weight();
  }
  return weights;
}

}  // namespace duet::server::service

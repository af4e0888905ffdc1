#include "model/retargeting/character.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "absl/strings/str_cat.h"
#include "model/motion/inferred_coordinates.h"
#include "model/motion/poses.h"
#include "model/motion/reading_setting.h"

namespace duet::retargeting {
namespace {

// The assumed leg length if it fits a person in no known unit, metres.
constexpr double kTypicalLeg = 1;
constexpr double kLargestUnit = 1000;
// In units of the file. A smaller character is treated as having no size.
constexpr double kSmallestLeg = 1e-3;

double Rounded(double value, double step) { return std::round(value / step) * step; }

// Frames, spread over a motion, in which distances are measured.
constexpr int kCheckedFrames = 100;
// Of the body's size.
constexpr double kOnePlace = 0.002;

class Body {
 public:
  Body(const motion::Skeleton& skeleton, const motion::Poses& poses)
      : skeleton_(skeleton), poses_(poses) {}

  // The mean distance of two joints; -1 if the skeleton lacks one.
  double Distance(const std::string& a, const std::string& b) const {
    const int from = skeleton_.Find(a), to = skeleton_.Find(b);
    if (from < 0 || to < 0 || poses_.empty()) return -1;
    double sum = 0;
    const int frames = std::min(poses_.frame_count(), kCheckedFrames);
    for (int i = 0; i < frames; ++i) {
      const auto pose = poses_[static_cast<int>(std::int64_t{i} * poses_.frame_count() / frames)];
      sum += static_cast<double>(motion::Distance(pose[static_cast<std::size_t>(from)],
                                                  pose[static_cast<std::size_t>(to)]));
    }
    return sum / frames;
  }

  double Size() const {
    double size = 0;
    const std::string& root = skeleton_.joint_names[static_cast<std::size_t>(skeleton_.root)];
    for (const std::string& joint : skeleton_.joint_names) {
      size = std::max(size, Distance(root, joint));
    }
    return size;
  }

 private:
  const motion::Skeleton& skeleton_;
  const motion::Poses& poses_;
};

// `size`: of the body, in the unit of the poses.
absl::Status CheckPlaces(absl::string_view source, const motion::Skeleton& skeleton,
                         const motion::Poses& poses, const JointMap& map,
                         const std::vector<std::string>& file_joints, double size) {
  const Body body(skeleton, poses);
  for (const char* name : {"hip", "shoulder"}) {
    const std::string left = absl::StrCat("left_", name), right = absl::StrCat("right_", name);
    const double distance = body.Distance(left, right);
    if (distance < 0 || !(distance < kOnePlace * size)) continue;
    const auto in_file = [&](const std::string& joint) {
      const auto index = static_cast<std::size_t>(skeleton.Find(joint));
      return file_joints[static_cast<std::size_t>(map.sources[index].terms[0].joint)];
    };
    return MendedBy(absl::InvalidArgumentError(
                        absl::StrCat(source, ": joints: expected ", left, " and ", right,
                                     " in two places, got ", in_file(left), " and ", in_file(right),
                                     " in one; specify a joint map such as ", left, "=NAME")),
                    motion::ReadingSetting::kJointMap);
  }
  return absl::OkStatus();
}

class ClipMaker {
 public:
  ClipMaker(const Character& character, absl::string_view source, const CharacterOptions& options)
      : character_(character), source_(source), options_(options) {}

  absl::StatusOr<motion::Clip> Make() {
    if (options_.report != nullptr) options_.report->file_joints = character_.tree.names;
    absl::StatusOr<JointMap> map = MapJoints(
        source_, character_.tree, options_.skeleton, options_.joint_overrides,
        options_.report == nullptr ? nullptr : &options_.report->joints, options_.missing_toes);
    if (!map.ok()) return map.status();
    const absl::StatusOr<double> scale = MetresPerUnit(map->straight);
    if (!scale.ok()) return scale.status();
    // If positions were meant to add to offsets, the poses are points, and only the rest has a
    // size.
    const double leg = options_.skeleton.feet ? *scale * StraightLeg(map->straight) : 0;
    motion::Clip clip;
    clip.joint_names = options_.skeleton.joint_names;
    clip.frame_rate_hz = character_.frame_rate_hz;
    for (int frame = 0; frame < character_.frame_count; ++frame) {
      clip.Append(ApplyJointMap(*map, character_.pose(frame)));
    }
    const motion::Coordinates coordinates{motion::LengthUnit::kMetres, UpAxis(clip)};
    for (motion::Vec3& position : clip.poses.all()) {
      position = ToWorld(coordinates, position * static_cast<float>(*scale));
    }
    const absl::Status body =
        CheckPlaces(source_, options_.skeleton, clip.poses, *map, character_.tree.names,
                    std::max(leg, Body(options_.skeleton, clip.poses).Size()));
    if (!body.ok()) return body;
    if (options_.fit != nullptr) {
      *options_.fit = {*scale, coordinates.up_axis, *std::move(map)};
    }
    return clip;
  }

 private:
  void Warn(const std::string& what) const {
    if (options_.report == nullptr) return;
    options_.report->remarks.push_back(absl::StrCat("warning: ", what));
  }

  absl::Status UnitNeeded(absl::string_view why) const {
    return MendedBy(absl::InvalidArgumentError(
                        absl::StrCat(source_, ": size: ", why, "; specify the metres per unit")),
                    motion::ReadingSetting::kMetresPerUnit);
  }

  // Requires a skeleton with feet.
  double StraightLeg(const std::vector<motion::Vec3>& straight) const {
    return LegLength(options_.skeleton, motion::Poses(options_.skeleton.joint_count(), straight));
  }

  absl::StatusOr<double> MetresPerUnit(const std::vector<motion::Vec3>& straight) {
    if (options_.metres_per_unit.has_value()) {
      ReportUnit({absl::StrCat(*options_.metres_per_unit, " m"), Origin::kGiven, ""});
      const absl::Status valid = CheckMetresPerUnit(*options_.metres_per_unit);
      if (!valid.ok()) return valid;
      return *options_.metres_per_unit;
    }
    if (!options_.skeleton.feet) {
      return UnitNeeded("expected a skeleton with feet to infer the unit, got none");
    }
    const double length = StraightLeg(straight);
    const std::string& root =
        options_.skeleton.joint_names[static_cast<size_t>(options_.skeleton.root)];
    if (const std::optional<motion::InferredUnit> unit = motion::InferUnit({length})) {
      const std::string why =
          absl::StrCat("foot to ", root, " is ", Rounded(length * unit->metres, 0.01), " m");
      ReportUnit({unit->name, Origin::kGuessed, why});
      return unit->metres;
    }
    if (!(length >= kSmallestLeg)) {
      return UnitNeeded(
          absl::StrCat("expected a distance from foot to ", root, ", got ", length, " units"));
    }
    ReportUnit({absl::StrCat(kTypicalLeg / length, " m"), Origin::kGuessed,
                absl::StrCat("foot to ", root, " is ", length, " units")});
    Warn(absl::StrCat("unit: a guess: legs of ", length,
                      " units are no person's in any usual unit, and were read as ", kTypicalLeg,
                      " m; specify the metres per unit if the size matters"));
    return kTypicalLeg / length;
  }

  void ReportUnit(Setting unit) const {
    if (options_.report != nullptr) options_.report->unit = std::move(unit);
  }

  void ReportUpAxis(motion::UpAxis axis, Origin origin, const char* why) const {
    if (options_.report == nullptr) return;
    options_.report->up_axis = Setting{std::string(UpAxisName(axis)), origin, why};
  }

  motion::UpAxis UpAxis(const motion::Clip& clip) {
    if (options_.up_axis.has_value()) {
      ReportUpAxis(*options_.up_axis, Origin::kGiven, "");
      return *options_.up_axis;
    }
    const std::optional<motion::UpAxis> found =
        motion::InferUpAxis(options_.skeleton, {&clip.poses});
    const motion::UpAxis up = found.value_or(motion::UpAxis::kYUp);
    ReportUpAxis(up, found.has_value() ? Origin::kGuessed : Origin::kDefault,
                 !found.has_value()             ? ""
                 : up == motion::UpAxis::kYDown ? "the feet are above the root along it"
                                                : "the feet are below the root along it");
    if (!found.has_value() && options_.skeleton.feet) {
      Warn(
          "up axis: expected a person who stands along y, z or -y, got none; assuming y; specify "
          "the up axis if it is another");
    }
    return up;
  }

  const Character& character_;
  absl::string_view source_;
  const CharacterOptions& options_;
};

}  // namespace

absl::Status CheckMetresPerUnit(double metres) {
  if (metres > 0 && metres <= kLargestUnit) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat(
      "metres per unit: expected more than 0 and at most ", kLargestUnit, ", got ", metres));
}

absl::StatusOr<motion::Clip> ToClip(const Character& character, absl::string_view source,
                                    const CharacterOptions& options) {
  return ClipMaker(character, source, options).Make();
}

absl::Status CheckBody(absl::string_view source, const motion::Skeleton& skeleton,
                       const motion::Poses& poses, const JointMap& map,
                       const std::vector<std::string>& file_joints) {
  return CheckPlaces(source, skeleton, poses, map, file_joints, Body(skeleton, poses).Size());
}

}  // namespace duet::retargeting

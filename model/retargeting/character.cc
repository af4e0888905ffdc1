#include "model/retargeting/character.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/base/index.h"
#include "model/base/text.h"
#include "model/motion/inferred_coordinates.h"
#include "model/motion/poses.h"
#include "model/motion/reading_setting.h"
#include "model/motion/skeleton.h"
#include "model/retargeting/joint_names.h"
#include "model/retargeting/rotation.h"

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

class ClipMaker {
 public:
  ClipMaker(const Character& character, absl::string_view source, const CharacterOptions& options)
      : character_(character),
        source_(source),
        options_(options),
        report_(options.report != nullptr ? *options.report : unread_) {}

  absl::StatusOr<motion::Clip> Make() {
    report_.file_joints = character_.tree.names;
    absl::StatusOr<JointMap> map =
        MapJoints(source_, character_.tree, options_.skeleton, options_.joint_overrides,
                  &report_.joints, options_.missing_toes);
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
        CheckBody(source_, options_.skeleton, clip.poses, *map, character_.tree.names, leg);
    if (!body.ok()) return body;
    if (options_.fit != nullptr) {
      *options_.fit = {*scale, coordinates.up_axis, *std::move(map)};
    }
    return clip;
  }

 private:
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
      report_.unit = Setting{absl::StrCat(*options_.metres_per_unit, " m"), Origin::kGiven, ""};
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
      report_.unit = Setting{
          unit->name, Origin::kGuessed,
          absl::StrCat("foot to ", root, " is ", Rounded(length * unit->metres, 0.01), " m")};
      return unit->metres;
    }
    if (!(length >= kSmallestLeg)) {
      return UnitNeeded(
          absl::StrCat("expected a distance from foot to ", root, ", got ", length, " units"));
    }
    report_.unit = Setting{absl::StrCat(kTypicalLeg / length, " m"), Origin::kGuessed,
                           absl::StrCat("foot to ", root, " is ", length, " units")};
    report_.remarks.push_back(
        absl::StrCat("warning: unit: a guess: legs of ", length,
                     " units are no person's in any usual unit, and were read as ", kTypicalLeg,
                     " m; specify the metres per unit if the size matters"));
    return kTypicalLeg / length;
  }

  motion::UpAxis UpAxis(const motion::Clip& clip) {
    if (options_.up_axis.has_value()) {
      report_.up_axis = Setting{std::string(UpAxisName(*options_.up_axis)), Origin::kGiven, ""};
      return *options_.up_axis;
    }
    const std::optional<motion::UpAxis> found =
        motion::InferUpAxis(options_.skeleton, {&clip.poses});
    const motion::UpAxis up = found.value_or(motion::UpAxis::kYUp);
    report_.up_axis = Setting{
        std::string(UpAxisName(up)), found.has_value() ? Origin::kGuessed : Origin::kDefault,
        !found.has_value()             ? ""
        : up == motion::UpAxis::kYDown ? "the feet are above the root along it"
                                       : "the feet are below the root along it"};
    if (!found.has_value() && options_.skeleton.feet) {
      report_.remarks.push_back(
          "warning: up axis: expected a person who stands along y, z or -y, got none; assuming y; "
          "specify the up axis if it is another");
    }
    return up;
  }

  const Character& character_;
  absl::string_view source_;
  const CharacterOptions& options_;
  ReadingReport unread_;
  ReadingReport& report_;
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
                       const std::vector<std::string>& file_joints, double least_size) {
  const Body body(skeleton, poses);
  const double size = std::max(least_size, body.Size());
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

namespace {

using base::Index;

// Cosines to the direction up the trunk: at most so much for the way from a hip to its foot, and to
// its knee. A person who sits has 0 for the thighs.
constexpr double kFootHangs = -0.3, kKneeHangs = 0.5;
// Cosine to the arm's own side: at least so much for the way from shoulder to hand.
constexpr double kArmAcross = -0.8;

// The joints of a body by name.
class BodyPose {
 public:
  explicit BodyPose(absl::Span<const motion::Vec3> body) : body_(body) {}

  Vec3d At(const std::string& joint) const {
    static const auto* const kSkeleton = new motion::Skeleton(motion::SbuSkeleton());
    return ToDouble(body_[static_cast<std::size_t>(kSkeleton->Find(joint))]);
  }

  Vec3d Way(const std::string& from, const std::string& to) const {
    return Unit(At(to) - At(from), {});
  }

  Vec3d Up() const { return Unit(At("neck") - (At("left_hip") + At("right_hip")) * 0.5, {}); }

 private:
  absl::Span<const motion::Vec3> body_;
};

// How upright a person stands in the world, with straight limbs.
double Uprightness(const BodyPose& pose) {
  const Vec3d up = {0, 1, 0};
  double sum = 2 * Dot(pose.Up(), up);
  for (const std::string side : {"left_", "right_"}) {
    sum -= Dot(pose.Way(side + "hip", side + "knee"), up);
    sum -= Dot(pose.Way(side + "knee", side + "foot"), up);
    sum += 0.5 * Dot(pose.Way(side + "shoulder", side + "elbow"),
                     pose.Way(side + "elbow", side + "hand"));
  }
  return sum;
}

// Whether a pose is that of a person whose legs hang below the trunk, in any direction of the
// world: the shoulders are on the sides of their hips, and no arm points across the body. In some
// files (LAFAN1, Kimodo) the offsets of all bones point along one axis; only their motion makes a
// person.
//
// Shape: [joints of motion::SbuSkeleton].
bool IsStanding(absl::Span<const motion::Vec3> body) {
  const BodyPose pose(body);
  const Vec3d up = pose.Up(), left = pose.Way("right_hip", "left_hip");
  if (!(Dot(left, pose.Way("right_shoulder", "left_shoulder")) > 0)) return false;
  for (const std::string side : {"left_", "right_"}) {
    if (!(Dot(up, pose.Way(side + "hip", side + "foot")) < kFootHangs)) return false;
    if (!(Dot(up, pose.Way(side + "hip", side + "knee")) < kKneeHangs)) return false;
    const Vec3d outwards = side == "left_" ? left : -left;
    if (!(Dot(outwards, pose.Way(side + "shoulder", side + "hand")) > kArmAcross)) return false;
  }
  return true;
}

}  // namespace

absl::StatusOr<std::optional<int>> FindRestFrame(const CharacterRig& rig, const motion::Clip& read,
                                                 absl::string_view source) {
  const absl::StatusOr<BodyRoles> roles = FindBodyRoles(source, read);
  if (!roles.ok()) return std::nullopt;
  std::vector<motion::Vec3> at_rest;
  for (const Vec3d& position : rig.positions) at_rest.push_back(ToFloat(position));
  if (IsStanding(ApplyJointMap(Compose(rig.joints, roles->body), at_rest))) return std::nullopt;
  std::optional<int> best;
  double most = 0;
  for (int frame = 0; frame < read.frame_count(); ++frame) {
    const std::vector<motion::Vec3> body = ApplyJointMap(roles->body, read.poses[frame]);
    const double upright = Uprightness(BodyPose(body));
    if (!IsStanding(body) || (best.has_value() && upright <= most)) continue;
    best = frame;
    most = upright;
  }
  if (best.has_value()) return best;
  return absl::InvalidArgumentError(
      absl::StrCat(source,
                   ": rig: rest pose: expected a standing person, at rest or in a frame of its "
                   "motion, got neither; export the rig in its T pose"));
}

Quaternion ToWorldAxes(motion::UpAxis up_axis) {
  const motion::Coordinates file{motion::LengthUnit::kMetres, up_axis};
  const auto in_world = [&file](motion::Vec3 axis) { return ToDouble(ToWorld(file, axis)); };
  return FromAxes(in_world({1, 0, 0}), in_world({0, 1, 0}), in_world({0, 0, 1}));
}

CharacterRig RestRig(const JointTree& tree, const CharacterFit& fit,
                     const std::vector<Vec3d>& positions) {
  const Quaternion to_world = ToWorldAxes(fit.up_axis);
  const auto in_metres = [&](Vec3d way) { return Rotate(to_world, way) * fit.metres_per_unit; };
  CharacterRig rig;
  rig.names = tree.names;
  rig.parents = tree.parents;
  rig.joints = fit.joints;
  for (std::size_t j = 0; j < tree.names.size(); ++j) {
    const int parent = tree.parents[j];
    rig.moves.push_back(parent < 0);
    if (!positions.empty()) {
      rig.positions.push_back(in_metres(positions[j] - positions[0]));
    } else {
      rig.positions.push_back(
          parent < 0 ? Vec3d{} : rig.positions[Index(parent)] + in_metres(tree.offsets[j]));
    }
  }
  return rig;
}

namespace {

constexpr std::size_t kMostShownNames = 30;

// Joints on both sides with one of these bases that the body does not use.
std::optional<motion::JointPair> FindEnds(const motion::Clip& clip, const JointMap& body,
                                          std::initializer_list<const char*> bases) {
  const auto is_used = [&body](int joint) {
    return std::any_of(body.sources.begin(), body.sources.end(), [joint](const auto& source) {
      return source.terms.size() == 1 && source.terms[0].joint == joint;
    });
  };
  const auto find = [&](BodySide side) {
    for (const char* base : bases) {
      for (int joint = 0; joint < clip.joint_count(); ++joint) {
        const ParsedJointName name = ParseJointName(clip.joint_names[Index(joint)]);
        if (name == ParsedJointName{side, base} && !is_used(joint)) return joint;
      }
    }
    return -1;
  };
  const motion::JointPair ends{find(BodySide::kLeft), find(BodySide::kRight)};
  return ends.left < 0 || ends.right < 0 ? std::nullopt : std::make_optional(ends);
}

absl::Status NoPerson(absl::string_view field, const motion::Clip& clip) {
  const std::size_t shown = std::min(clip.joint_names.size(), kMostShownNames);
  const auto append = [](std::string* out, const std::string& name) {
    absl::StrAppend(out, base::Printable(name, base::kLongestQuote));
  };
  return absl::InvalidArgumentError(absl::StrCat(
      field,
      ": joints: expected those of a person, named as in docs/formats.md, to write onto a rig; "
      "got ",
      absl::StrJoin(clip.joint_names.begin(),
                    clip.joint_names.begin() + static_cast<std::ptrdiff_t>(shown), ", ", append),
      shown < clip.joint_names.size() ? ", ..." : ""));
}

}  // namespace

absl::StatusOr<BodyRoles> FindBodyRoles(absl::string_view field, const motion::Clip& clip) {
  absl::StatusOr<JointMap> body =
      MapJoints(field, clip.joint_names, clip.poses, motion::SbuSkeleton());
  if (!body.ok()) return NoPerson(field, clip);
  BodyRoles roles;
  roles.toes = FindEnds(clip, *body, {"toe", "toebase", "toes", "ball", "footend", "foot"});
  roles.hands = FindEnds(clip, *body, {"hand", "handmiddle1", "middle1", "middle01"});
  roles.body = *std::move(body);
  return roles;
}

JointMap Compose(const JointMap& first, const JointMap& second) {
  JointMap composed;
  for (const JointSource& outer : second.sources) {
    JointSource source;
    for (const JointSource::Term& term : outer.terms) {
      for (const JointSource::Term& inner :
           first.sources[static_cast<std::size_t>(term.joint)].terms) {
        source.terms.push_back({inner.joint, inner.weight * term.weight});
      }
    }
    composed.sources.push_back(std::move(source));
  }
  return composed;
}

}  // namespace duet::retargeting

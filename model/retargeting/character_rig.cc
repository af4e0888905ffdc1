#include "model/retargeting/character_rig.h"

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/base/index.h"
#include "model/base/printable.h"
#include "model/base/text.h"
#include "model/motion/skeleton.h"
#include "model/retargeting/joint_names.h"
#include "model/retargeting/rotation.h"

namespace duet::retargeting {
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

CharacterRig RestRig(const JointTree& tree, const CharacterFit& fit) {
  const Quaternion to_world = ToWorldAxes(fit.up_axis);
  CharacterRig rig;
  rig.names = tree.names;
  rig.parents = tree.parents;
  rig.joints = fit.joints;
  for (std::size_t j = 0; j < tree.names.size(); ++j) {
    const int parent = tree.parents[j];
    const Vec3d offset = Rotate(to_world, tree.offsets[j]) * fit.metres_per_unit;
    rig.positions.push_back(parent < 0 ? Vec3d{} : rig.positions[Index(parent)] + offset);
    rig.moves.push_back(parent < 0);
  }
  return rig;
}

CharacterRig RestRig(const JointTree& tree, const CharacterFit& fit,
                     const std::vector<Vec3d>& positions) {
  const Quaternion to_world = ToWorldAxes(fit.up_axis);
  CharacterRig rig = RestRig(tree, fit);
  for (std::size_t j = 0; j < positions.size(); ++j) {
    const Vec3d from_root = positions[j] - positions[0];
    rig.positions[j] = Rotate(to_world, from_root) * fit.metres_per_unit;
  }
  return rig;
}

void NoteRestFrame(int frame, ReadingReport* report) {
  if (report == nullptr) return;
  report->remarks.push_back(
      absl::StrCat("rest pose: that of frame ", frame,
                   ", because the bones of the rig at rest make no standing person"));
}

namespace {

constexpr std::size_t kMostNamesInError = 30;

class RoleFinder {
 public:
  RoleFinder(const motion::Clip& clip, const JointMap& body) : clip_(clip), body_(body) {}

  // Joints on both sides with one of these bases that the body does not use.
  std::optional<motion::JointPair> Find(std::initializer_list<const char*> bases) const {
    const int left = Find(BodySide::kLeft, bases), right = Find(BodySide::kRight, bases);
    if (left < 0 || right < 0) return std::nullopt;
    return motion::JointPair{left, right};
  }

 private:
  int Find(BodySide side, std::initializer_list<const char*> bases) const {
    for (const char* base : bases) {
      for (int joint = 0; joint < clip_.joint_count(); ++joint) {
        const std::string& name = clip_.joint_names[static_cast<std::size_t>(joint)];
        if (ParseJointName(name) == ParsedJointName{side, base} && !IsUsed(joint)) return joint;
      }
    }
    return -1;
  }

  bool IsUsed(int joint) const {
    return std::any_of(body_.sources.begin(), body_.sources.end(), [joint](const auto& source) {
      return source.terms.size() == 1 && source.terms[0].joint == joint;
    });
  }

  const motion::Clip& clip_;
  const JointMap& body_;
};

absl::Status NoPerson(absl::string_view field, const motion::Clip& clip) {
  const std::size_t shown = std::min(clip.joint_names.size(), kMostNamesInError);
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
  const RoleFinder finder(clip, *body);
  roles.toes = finder.Find({"toe", "toebase", "toes", "ball", "footend", "foot"});
  roles.hands = finder.Find({"hand", "handmiddle1", "middle1", "middle01"});
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

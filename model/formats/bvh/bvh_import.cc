#include "model/formats/bvh/bvh_import.h"

#include <cmath>

#include "absl/strings/str_cat.h"

namespace duet::formats::bvh {
namespace {

// From the foot up to the root (torso or pelvis) along the bones.
constexpr double kShortestLeg = 0.7, kLongestLeg = 1.4;
constexpr double kLargestUnit = 1000;
// Frame times carry 3 to 7 digits.
constexpr double kRateTolerance = 5e-4;

struct Unit {
  const char* name;
  double metres;
};
constexpr Unit kUnits[] = {{"centimetres", 0.01},
                           {"metres", 1},
                           {"millimetres", 0.001},
                           {"inches", 0.0254},
                           {"CMU's unit (0.45 to the inch)", 0.0254 / 0.45}};

// The joints below one ROOT.
std::vector<int> JointsOfPerson(const BvhDocument& document, int person) {
  std::vector<int> root_of(document.joints.size());
  int roots = 0;
  for (std::size_t j = 0; j < document.joints.size(); ++j) {
    const int parent = document.joints[j].parent;
    root_of[j] = parent < 0 ? roots++ : root_of[static_cast<size_t>(parent)];
  }
  std::vector<int> joints;
  for (std::size_t j = 0; j < document.joints.size(); ++j) {
    if (root_of[j] == (person < roots ? person : 0)) joints.push_back(static_cast<int>(j));
  }
  return joints;
}

class Importer {
 public:
  Importer(const BvhDocument& document, absl::string_view source, const BvhImportOptions& options)
      : document_(document),
        kinematics_(document),
        source_(source),
        options_(options),
        joints_(JointsOfPerson(document, options.person)) {}

  absl::StatusOr<motion::Clip> Import() {
    absl::StatusOr<retargeting::JointMap> map = retargeting::MapJoints(
        source_, Names(), Pose(0), options_.skeleton, options_.joint_overrides);
    if (!map.ok()) return map.status();
    for (const std::string& note : map->notes) Note(note);
    NotePositionChannels();
    motion::Clip clip;
    clip.joint_names = options_.skeleton.joint_names;
    clip.frame_rate_hz = FrameRate();
    for (int frame = 0; frame < document_.frame_count; ++frame) {
      const std::vector<motion::Vec3> pose = ApplyJointMap(*map, Pose(frame));
      clip.Append(pose);
    }
    return ToMetres(std::move(clip));
  }

 private:
  void Note(std::string note) {
    if (options_.notes != nullptr) options_.notes->push_back(std::move(note));
  }

  void NotePositionChannels() {
    const std::optional<PositionChannels> found = FindPositionChannels(document_);
    if (!found.has_value()) return;
    Note(*found == PositionChannels::kReplaceOffset
             ? "position channels below the root: in place of OFFSET, as most joints have it"
             : "position channels below the root: added to OFFSET, as most joints have it");
  }

  std::vector<std::string> Names() const {
    std::vector<std::string> names;
    for (int joint : joints_) names.push_back(document_.joints[static_cast<size_t>(joint)].name);
    return names;
  }

  std::vector<motion::Vec3> Pose(int frame) const {
    const std::vector<retargeting::Vec3d> all = kinematics_.Positions(frame);
    std::vector<motion::Vec3> pose;
    for (int joint : joints_) pose.push_back(ToFloat(all[static_cast<size_t>(joint)]));
    return pose;
  }

  double FrameRate() const {
    const double rate = 1 / document_.frame_time_s;
    const double whole = std::round(rate);
    return whole >= 1 && std::abs(rate - whole) < kRateTolerance * whole ? whole : rate;
  }

  absl::StatusOr<motion::Clip> ToMetres(motion::Clip clip) {
    absl::StatusOr<double> scale = MetresPerUnit(clip);
    if (!scale.ok()) return scale.status();
    const motion::Coordinates coordinates{motion::LengthUnit::kMetres, FindUpAxis(clip)};
    for (motion::Vec3& position : clip.poses.all()) {
      position = ToWorld(coordinates, position * static_cast<float>(*scale));
    }
    return clip;
  }

  // Along the bones from the left foot to the root, in the file's unit. Requires feet.
  double LegLength(const motion::Clip& clip) const {
    const std::vector<int> parents = options_.skeleton.Parents();
    double length = 0;
    for (int joint = options_.skeleton.feet->left; joint != options_.skeleton.root;) {
      const int parent = parents[static_cast<size_t>(joint)];
      length += static_cast<double>(Distance(clip.at(0, joint), clip.at(0, parent)));
      joint = parent;
    }
    return length;
  }

  static absl::StatusOr<double> CheckUnit(double metres) {
    if (metres > 0 && metres <= kLargestUnit) return metres;
    return absl::InvalidArgumentError(absl::StrCat(
        "metres per unit: came ", metres, ", wanted more than 0 and at most ", kLargestUnit));
  }

  absl::StatusOr<double> MetresPerUnit(const motion::Clip& clip) {
    if (options_.metres_per_unit.has_value()) return CheckUnit(*options_.metres_per_unit);
    if (!options_.skeleton.feet) {
      return absl::InvalidArgumentError(absl::StrCat(
          source_,
          ": size: the skeleton has no feet to tell it by; say how many metres a unit has"));
    }
    const double length = LegLength(clip);
    for (const Unit& unit : kUnits) {
      const double metres = length * unit.metres;
      if (metres < kShortestLeg || metres > kLongestLeg) continue;
      Note(absl::StrCat("unit: ", unit.name, " (foot to ",
                        options_.skeleton.joint_names[static_cast<size_t>(options_.skeleton.root)],
                        " is then ", std::round(metres * 100) / 100, " m)"));
      return unit.metres;
    }
    return absl::InvalidArgumentError(
        absl::StrCat(source_, ": size: foot to root came as ", length,
                     " units, which is no person's ", kShortestLeg, " to ", kLongestLeg,
                     " m in metres, centimetres, millimetres, inches or CMU's unit; say how many "
                     "metres a unit has"));
  }

  motion::UpAxis FindUpAxis(const motion::Clip& clip) {
    if (options_.up_axis.has_value()) return *options_.up_axis;
    const motion::Skeleton& skeleton = options_.skeleton;
    if (!skeleton.feet) return motion::UpAxis::kYUp;
    motion::Vec3 up;
    for (int frame = 0; frame < clip.frame_count(); ++frame) {
      const motion::Vec3 feet =
          (clip.at(frame, skeleton.feet->left) + clip.at(frame, skeleton.feet->right)) / 2;
      const motion::Vec3 body = clip.at(frame, skeleton.root) - feet;
      if (Norm(body) > 0) up += body / Norm(body);
    }
    if (up.z > std::abs(up.y)) {
      Note("up axis: z (the feet are below the root along it)");
      return motion::UpAxis::kZUp;
    }
    if (-up.y > std::abs(up.z)) {
      Note("up axis: y pointing down (the feet are above the root along it)");
      return motion::UpAxis::kYDown;
    }
    return motion::UpAxis::kYUp;
  }

  const BvhDocument& document_;
  const BvhKinematics kinematics_;
  absl::string_view source_;
  const BvhImportOptions& options_;
  std::vector<int> joints_;
};

}  // namespace

absl::StatusOr<motion::Clip> FromBvh(const BvhDocument& document, absl::string_view source,
                                     const BvhImportOptions& options) {
  return Importer(document, source, options).Import();
}

}  // namespace duet::formats::bvh

#include "tests/formats/asf/asf_fixture.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "absl/strings/str_cat.h"
#include "model/motion/skeleton.h"
#include "model/retargeting/pose_fitting.h"
#include "model/retargeting/rig.h"

namespace duet::test {
namespace {

using retargeting::Quaternion;
using retargeting::RigJoint;
using retargeting::Vec3d;

constexpr double kDegrees = 180 / 3.14159265358979323846;
constexpr double kUnitsPerMetre = 0.45 / 0.0254;

// R = Rz Ry Rx, degrees.
Vec3d XyzAngles(Quaternion q) {
  const Vec3d x = Rotate(q, {1, 0, 0}), y = Rotate(q, {0, 1, 0}), z = Rotate(q, {0, 0, 1});
  return Vec3d{std::atan2(y.z, z.z), std::asin(std::clamp(-x.z, -1.0, 1.0)), std::atan2(x.y, x.x)} *
         kDegrees;
}

// Axes of joint j, degrees about x, then y, then z.
Vec3d Axes(std::size_t j) {
  const double k = static_cast<double>(j);
  return {10 + 3 * k, -20 + 5 * k, 30 - 4 * k};
}

Quaternion FromXyz(Vec3d degrees) {
  return retargeting::AxisAngle({0, 0, 1}, degrees.z / kDegrees) *
         retargeting::AxisAngle({0, 1, 0}, degrees.y / kDegrees) *
         retargeting::AxisAngle({1, 0, 0}, degrees.x / kDegrees);
}

std::string Text(Vec3d v) { return absl::StrCat(v.x, " ", v.y, " ", v.z); }

// From where a joint is to where its children are.
Vec3d Extent(const retargeting::Rig& rig, std::size_t j) {
  if (rig.joints[j].kind == RigJoint::Kind::kLeaf) return rig.joints[j].end_offset;
  for (const RigJoint& other : rig.joints) {
    if (other.parent == static_cast<int>(j)) return other.offset;
  }
  return {};
}

std::string MakeAsf(const retargeting::Rig& rig) {
  std::string text =
      "# made by a test\n:version 1.10\n:name person\n:units\n  mass 1.0\n  length 0.45\n"
      "  angle deg\n:documentation\n  bones of a rig\n:root\n  order TX TY TZ RX RY RZ\n"
      "  axis XYZ\n  position 0 0 0\n  orientation 0 0 0\n:bonedata\n";
  std::string hierarchy = "  root torso\n";
  for (std::size_t j = 0; j < rig.joints.size(); ++j) {
    const Vec3d extent = Extent(rig, j) * kUnitsPerMetre;
    absl::StrAppend(&text, "  begin\n    id ", j + 1, "\n    name ", rig.joints[j].name,
                    "\n    direction ", Text(retargeting::Unit(extent, {0, 1, 0})), "\n    length ",
                    Norm(extent), "\n    axis ", Text(Axes(j)),
                    "  XYZ\n    dof rx ry rz\n    limits (-160.0 20.0)\n"
                    "           (-70.0 70.0)\n           (-60.0 70.0)\n  end\n");
    std::string children;
    for (const RigJoint& other : rig.joints) {
      if (other.parent == static_cast<int>(j)) absl::StrAppend(&children, " ", other.name);
    }
    if (!children.empty()) absl::StrAppend(&hierarchy, "  ", rig.joints[j].name, children, "\n");
  }
  return absl::StrCat(text, ":hierarchy\n  begin\n", hierarchy, "  end\n");
}

}  // namespace

AsfFiles MakeAsfFiles(const motion::Clip& clip) {
  const retargeting::Rig rig = retargeting::MakeRig(motion::SbuSkeleton(), clip);
  AsfFiles files;
  files.asf = MakeAsf(rig);
  files.amc = "#!OML:ASF person.asf\n:FULLY-SPECIFIED\n:DEGREES\n";
  retargeting::PoseFitter fitter(rig, clip.frame_rate_hz);
  for (int frame = 0; frame < clip.frame_count(); ++frame) {
    const retargeting::RigPose& pose = fitter.Fit(clip.poses[frame]);
    absl::StrAppend(&files.amc, frame + 1, "\nroot ", Text(pose.root_position * kUnitsPerMetre),
                    " 0 0 0\n");
    for (std::size_t j = 0; j < rig.joints.size(); ++j) {
      const Quaternion axes = FromXyz(Axes(j));
      absl::StrAppend(&files.amc, rig.joints[j].name, " ",
                      Text(XyzAngles(Inverse(axes) * pose.rotations[j] * axes)), "\n");
    }
  }
  return files;
}

}  // namespace duet::test

#include "model/body/touch.h"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "model/motion/capsules.h"

namespace duet::body {
namespace {

// A hand's joint is inside the hand, and captures have errors of centimetres.
constexpr double kReachMetres = 0.05;

bool IsLimb(const motion::BodyPart& part) {
  return part.name.find("arm") != std::string::npos || part.name.find("leg") != std::string::npos;
}

bool Touches(const motion::Poses& leader, int frame, motion::Vec3 end,
             const motion::Skeleton& skeleton, const std::vector<double>& radii) {
  for (size_t i = 0; i < skeleton.bones.size(); ++i) {
    const motion::Bone& bone = skeleton.bones[i];
    const double distance =
        SegmentDistance(leader.at(frame, bone.parent), leader.at(frame, bone.child), end, end);
    if (distance <= radii[i] + kReachMetres) return true;
  }
  return false;
}

}  // namespace

std::vector<int> LimbEnds(const motion::Skeleton& skeleton,
                          const std::vector<motion::BodyPart>& parts) {
  std::vector<bool> goes_on(static_cast<size_t>(skeleton.joint_count()));
  for (const motion::Bone& bone : skeleton.bones) goes_on[static_cast<size_t>(bone.parent)] = true;
  std::vector<int> ends;
  for (const motion::BodyPart& part : parts) {
    if (!IsLimb(part)) continue;
    for (const int joint : part.joints) {
      if (!goes_on[static_cast<size_t>(joint)]) ends.push_back(joint);
    }
  }
  return ends;
}

double TouchShare(const motion::Poses& leader, const motion::Poses& follower,
                  const motion::Skeleton& skeleton, const std::vector<motion::BodyPart>& parts) {
  const std::vector<int> ends = LimbEnds(skeleton, parts);
  if (ends.empty()) return std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> radii = CapsuleRadii(skeleton, parts);
  double touching = 0;
  for (int t = 0; t < follower.frame_count(); ++t) {
    const bool touches = std::any_of(ends.begin(), ends.end(), [&](int end) {
      return Touches(leader, t, follower.at(t, end), skeleton, radii);
    });
    if (touches) ++touching;
  }
  return touching / follower.frame_count();
}

}  // namespace duet::body

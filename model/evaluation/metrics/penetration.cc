#include "model/evaluation/metrics/penetration.h"

#include <algorithm>
#include <cstddef>

#include "model/motion/capsules.h"

namespace duet::evaluation::metrics {
namespace {

// The deepest overlap of two bodies in one frame.
double FrameDepth(const motion::Poses& leader, const motion::Poses& follower, int frame,
                  const motion::Skeleton& skeleton, const std::vector<double>& radii) {
  double deepest = 0;
  for (size_t i = 0; i < skeleton.bones.size(); ++i) {
    const motion::Bone& a = skeleton.bones[i];
    for (size_t j = 0; j < skeleton.bones.size(); ++j) {
      const motion::Bone& b = skeleton.bones[j];
      const double distance =
          SegmentDistance(leader.at(frame, a.parent), leader.at(frame, a.child),
                          follower.at(frame, b.parent), follower.at(frame, b.child));
      deepest = std::max(deepest, radii[i] + radii[j] - distance);
    }
  }
  return deepest;
}

}  // namespace

Penetration MeasurePenetration(const motion::Poses& leader, const motion::Poses& follower,
                               const motion::Skeleton& skeleton,
                               const std::vector<motion::BodyPart>& parts) {
  const std::vector<double> radii = CapsuleRadii(skeleton, parts);
  Penetration result;
  double touching = 0, sum = 0;
  for (int t = 0; t < leader.frame_count(); ++t) {
    const double depth = FrameDepth(leader, follower, t, skeleton, radii);
    if (depth <= 0) continue;
    ++touching;
    sum += depth;
    result.max_depth_metres = std::max(result.max_depth_metres, depth);
  }
  if (touching == 0) return result;
  result.frequency = touching / leader.frame_count();
  result.mean_depth_metres = sum / touching;
  return result;
}

}  // namespace duet::evaluation::metrics

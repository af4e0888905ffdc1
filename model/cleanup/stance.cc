#include "model/cleanup/stance.h"

#include <cstddef>
#include <vector>

#include "model/body/passing_poses.h"
#include "model/cleanup/directions.h"
#include "model/cleanup/lasting.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;

// How far feet that came together are apart, in lengths of the leg.
constexpr float kNarrow = 0.4f;

// Moves both feet by a share of their way to places below the middle of the hips.
void ComeTogether(const motion::JointPair& hips, const body::Body& body, float share,
                  absl::Span<Vec3> pose) {
  const auto at = [&](int joint) { return pose[static_cast<std::size_t>(joint)]; };
  const Vec3 middle = (at(hips.left) + at(hips.right)) / 2;
  const Vec3 facing = body::Facing(hips, pose);
  const Vec3 stride = body::Stride(body, pose);
  const Vec3 half = stride * (kNarrow / 2 * LengthOf(body.legs[0], pose) / Norm(stride));
  for (std::size_t leg = 0; leg < body.legs.size(); ++leg) {
    const Vec3 foot = at(body.legs[leg].end);
    const Vec3 way = Level(middle + (leg == 0 ? half * -1.0f : half) - foot);
    Reach(body.legs[leg], foot + way * share, facing, pose);
  }
}

}  // namespace

void NarrowStance(const motion::Skeleton& skeleton, const body::Body& body,
                  const StanceOptions& options, const Timing& timing, motion::Poses* poses) {
  if (!skeleton.hips || body.legs.size() != 2 || options.longest_seconds == 0) return;
  const auto astride = [&](int t) { return body::IsAstride(body, (*poses)[t]); };
  const std::vector<float> shares = SharesOfLasting(
      astride, {options.longest_seconds, options.ease_seconds}, timing, poses->frame_count());
  for (int t = timing.settled; t < poses->frame_count() && !shares.empty(); ++t) {
    const float share = shares[static_cast<std::size_t>(t)];
    if (share > 0) ComeTogether(*skeleton.hips, body, share, (*poses)[t]);
  }
}

}  // namespace duet::cleanup

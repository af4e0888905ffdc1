#include "model/engine/resting_leader.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "model/motion/limb_lengths.h"

namespace duet::engine {
namespace {

// The leader's velocity is that of its last frames, enlarged, because a motion that begins grows
// faster. It falls by a factor of e in each of these times after the last frame.
constexpr double kVelocitySeconds = 0.034;
constexpr double kEnlarged = 1.3;
constexpr double kRestSeconds = 0.3;

}  // namespace

motion::Poses ComeToRest(const motion::Skeleton& skeleton, const motion::Poses& known,
                         double frame_rate_hz, absl::Span<const double> seconds) {
  const int last = known.frame_count() - 1;
  const int back =
      std::min(last, std::max(1, static_cast<int>(std::lround(kVelocitySeconds * frame_rate_hz))));
  motion::Poses resting(0, known.joint_count());
  for (const double since : seconds) {
    const double coasting = kEnlarged * kRestSeconds * (1 - std::exp(-since / kRestSeconds));
    const float steps = back == 0 ? 0 : static_cast<float>(coasting * frame_rate_hz / back);
    std::vector<motion::Vec3> pose(known[last].begin(), known[last].end());
    for (std::size_t j = 0; j < pose.size(); ++j) {
      pose[j] += (known[last][j] - known[last - back][j]) * steps;
    }
    resting.Append(pose);
  }
  if (resting.empty()) return resting;
  const motion::Poses newest(known.joint_count(), {known[last].begin(), known[last].end()});
  SetBoneLengths(skeleton, MedianBoneLengths(skeleton, newest), &resting);
  return resting;
}

}  // namespace duet::engine

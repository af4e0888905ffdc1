#include "model/evaluation/judge/judge_input.h"

#include <algorithm>

#include "model/engine/window_standardisation.h"

namespace duet::evaluation::judge {
namespace {

motion::Poses StandardFollower(const motion::Skeleton& skeleton, const dataset::Sequence& sequence,
                               motion::StandardOrigin origin) {
  engine::SynthesisWindow window;
  window.leader = sequence.pair.leader.poses;
  window.partner_direction = sequence.partner_direction;
  return WindowStandardisation(skeleton, window, origin).Apply(sequence.pair.follower.poses);
}

}  // namespace

motion::Poses JudgeInput(const motion::Skeleton& skeleton, const dataset::Sequence& sequence) {
  const motion::Poses from_leader =
      StandardFollower(skeleton, sequence, motion::StandardOrigin::kEveryFrame);
  const motion::Poses in_world =
      StandardFollower(skeleton, sequence, motion::StandardOrigin::kFirstFrame);
  const float rate = static_cast<float>(sequence.pair.follower.frame_rate_hz);
  const int frames = from_leader.frame_count(), joints = skeleton.joint_count();
  motion::Poses input(frames, kJudgeParts * joints);
  for (int t = 0; t < frames; ++t) {
    const int before = std::max(t - 1, 0), after = std::min(t + 1, frames - 1);
    const float a_second = after == before ? 0 : rate / static_cast<float>(after - before);
    for (int j = 0; j < joints; ++j) {
      input.at(t, j) = from_leader.at(t, j);
      input.at(t, joints + j) = from_leader.at(t, j) - from_leader.at(t, skeleton.root);
      input.at(t, 2 * joints + j) = (in_world.at(after, j) - in_world.at(before, j)) * a_second;
    }
  }
  return input;
}

}  // namespace duet::evaluation::judge

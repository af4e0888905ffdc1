#include "model/evaluation/judge/judge_input.h"

#include <algorithm>

#include "model/engine/window_frame.h"

namespace duet::evaluation::judge {
namespace {

std::vector<motion::Vec3> StandardFollower(const motion::Skeleton& skeleton,
                                           const dataset::Sequence& sequence,
                                           motion::StandardOrigin origin) {
  engine::SynthesisWindow window;
  window.leader = sequence.pair.leader.positions;
  window.partner_direction = sequence.partner_direction;
  return WindowFrame(skeleton, window, origin).Apply(sequence.pair.follower.positions);
}

}  // namespace

std::vector<motion::Vec3> JudgeInput(const motion::Skeleton& skeleton,
                                     const dataset::Sequence& sequence) {
  const motion::Clip& follower = sequence.pair.follower;
  const int joints = skeleton.joint_count(), frames = follower.frame_count();
  const std::vector<motion::Vec3> from_leader =
      StandardFollower(skeleton, sequence, motion::StandardOrigin::kEveryFrame);
  const std::vector<motion::Vec3> in_world =
      StandardFollower(skeleton, sequence, motion::StandardOrigin::kFirstFrame);
  const auto index = [&](int frame, int joint) {
    return static_cast<size_t>(frame * joints + joint);
  };
  std::vector<motion::Vec3> input;
  for (int t = 0; t < frames; ++t) {
    const motion::Vec3 root = from_leader[index(t, skeleton.root)];
    for (int j = 0; j < joints; ++j) input.push_back(from_leader[index(t, j)]);
    for (int j = 0; j < joints; ++j) input.push_back(from_leader[index(t, j)] - root);
    const int before = std::max(t - 1, 0), after = std::min(t + 1, frames - 1);
    const float a_second = after == before ? 0
                                           : static_cast<float>(follower.frame_rate_hz) /
                                                 static_cast<float>(after - before);
    for (int j = 0; j < joints; ++j) {
      input.push_back((in_world[index(after, j)] - in_world[index(before, j)]) * a_second);
    }
  }
  return input;
}

}  // namespace duet::evaluation::judge

#include "model/evaluation/judge/judge_input.h"

#include <algorithm>

#include "model/engine/window_standardisation.h"

namespace duet::evaluation::judge {
namespace {

motion::Poses Standard(const motion::Skeleton& skeleton, const dataset::Sequence& sequence,
                       const motion::Poses& poses, motion::StandardOrigin origin) {
  engine::SynthesisWindow window;
  window.leader = sequence.pair.leader.poses;
  window.partner_direction = sequence.partner_direction;
  return WindowStandardisation(skeleton, window, origin).Apply(poses);
}

// Writes where each joint is, seen from the root, from column `first` on.
void PutAboutRoot(const motion::Poses& poses, int root, int first, motion::Poses* input) {
  for (int t = 0; t < poses.frame_count(); ++t) {
    for (int j = 0; j < poses.joint_count(); ++j) {
      input->at(t, first + j) = poses.at(t, j) - poses.at(t, root);
    }
  }
}

// Writes central differences, one-sided at the ends, times the rate.
void PutVelocity(const motion::Poses& poses, double rate, int first, motion::Poses* input) {
  const int frames = poses.frame_count();
  for (int t = 0; t < frames; ++t) {
    const int before = std::max(t - 1, 0), after = std::min(t + 1, frames - 1);
    const float a_second =
        after == before ? 0 : static_cast<float>(rate) / static_cast<float>(after - before);
    for (int j = 0; j < poses.joint_count(); ++j) {
      input->at(t, first + j) = (poses.at(after, j) - poses.at(before, j)) * a_second;
    }
  }
}

}  // namespace

motion::Poses JudgeInput(const motion::Skeleton& skeleton, const dataset::Sequence& sequence,
                         JudgeSees sees) {
  constexpr auto kEveryFrame = motion::StandardOrigin::kEveryFrame;
  constexpr auto kFirstFrame = motion::StandardOrigin::kFirstFrame;
  const motion::Poses& follower = sequence.pair.follower.poses;
  const motion::Poses& leader = sequence.pair.leader.poses;
  const double rate = sequence.pair.follower.frame_rate_hz;
  const motion::Poses from_leader = Standard(skeleton, sequence, follower, kEveryFrame);
  const int frames = from_leader.frame_count(), joints = skeleton.joint_count();
  motion::Poses input(frames, JudgeParts(sees) * joints);
  for (int t = 0; t < frames; ++t) {
    std::copy(from_leader[t].begin(), from_leader[t].end(), input[t].begin());
  }
  PutAboutRoot(from_leader, skeleton.root, joints, &input);
  PutVelocity(Standard(skeleton, sequence, follower, kFirstFrame), rate, 2 * joints, &input);
  if (sees == JudgeSees::kFollower) return input;
  const motion::Poses leads = Standard(skeleton, sequence, leader, kFirstFrame);
  PutAboutRoot(leads, skeleton.root, 3 * joints, &input);
  PutVelocity(leads, rate, 4 * joints, &input);
  return input;
}

}  // namespace duet::evaluation::judge

#ifndef DUET_MODEL_ENGINE_CRITIC_H_
#define DUET_MODEL_ENGINE_CRITIC_H_

#include <vector>

#include "absl/types/span.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::engine {

// The critic's frames: each is the mean of so many seconds of the window, which removes sensor
// noise and jitter.
inline constexpr double kCriticFrameSeconds = 2.0 / 15;
inline constexpr int kCriticUnits = 16;
// Frames that each of the two convolutions sees, and their distance in the second one.
inline constexpr int kCriticKernel = 3, kCriticDilation = 2;

// Number of values of each of the critic's frames.
int CriticInputs(const motion::Skeleton& skeleton, int classes);

// What the critic sees of a window. In coordinates turned so that the leader's root looks at the
// follower's, on average over the window, for each joint of the follower: its position relative to
// the leader's root, its position relative to the follower's root, and half its velocity. Then the
// label weights. Frames that do not fill a mean are left out; a window shorter than two means is
// not averaged. Shapes: leader, follower [frames, joints], labels [frames, classes]; returns
// [critic frames, CriticInputs]. Units: metres, m/s.
std::vector<float> CriticInput(const motion::Skeleton& skeleton, double frame_rate_hz,
                               const motion::Poses& leader, const motion::Poses& follower,
                               absl::Span<const float> labels);

// Shapes: U kCriticUnits, K kCriticKernel, I CriticInputs. Row-major, outputs outermost.
struct CriticWeights {
  std::vector<float> frames_weight, frames_bias;  // [U, I], [U]
  std::vector<float> near_weight, near_bias;      // [U, U, K], [U]
  std::vector<float> far_weight, far_bias;        // [U, U, K], [U]
  std::vector<float> output_weight, output_bias;  // [1, U], [1]
};

// A small network that tells captured followers from sampled ones. Its score is a term of the
// choice among several samples (candidates.h). It was trained on captured and sampled followers
// that passed the same clean-up, so it does not see the clean-up but the motion.
//
//   x = relu(frames(input)); x += relu(near(x)); x += relu(far(x)); score = mean(output(x))
//
// Cost:    linear in the frames; about 15 us for a window of 3 s.
// Threads: const methods are safe to call concurrently.
class Critic {
 public:
  // Requires weights of the sizes above.
  Critic(motion::Skeleton skeleton, double frame_rate_hz, CriticWeights weights);

  // The log of the odds that a follower is captured: above 0 rather captured than sampled.
  // Shapes: as CriticInput. Requires at least one frame.
  float Score(const motion::Poses& leader, const motion::Poses& follower,
              absl::Span<const float> labels) const;

 private:
  motion::Skeleton skeleton_;
  double frame_rate_hz_;
  CriticWeights weights_;  // with inputs outermost: [I, U], [K, U, U]
};

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_CRITIC_H_

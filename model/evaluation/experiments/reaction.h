#ifndef DUET_MODEL_EVALUATION_EXPERIMENTS_REACTION_H_
#define DUET_MODEL_EVALUATION_EXPERIMENTS_REACTION_H_

#include <string>
#include <vector>

#include "model/body/limbs.h"
#include "model/dataset/dataset.h"
#include "model/evaluation/report/table.h"
#include "model/motion/poses.h"

// How strongly, and when, a follower gives way to what a leader does, beside the captured follower.

namespace duet::evaluation::experiments {

// The time for which a padded leader holds its first pose before and its last pose after the clip.
inline constexpr double kPaddingSeconds = 1;

// The sequence with both people held still before and after it. Returns the frames before.
int PadSequence(dataset::Sequence* sequence);

// How far a follower goes back about the leader's action, metres.
struct Amplitude {
  double head = 0, torso = 0;
};

// One answer to a captured leader.
struct Reaction {
  Amplitude amplitude;
  double correlation = 0;  // of the velocity away from the leader with the captured follower's
};

// Captured and synthesised reactions to one leader's clip.
struct ReactionPair {
  int leader = 0;
  int interaction_class = 0;
  Amplitude captured;
  Reaction plain, padded;
};

// Measures followers of a data set's clips.
//
// Threads: const methods are safe to call concurrently.
class ReactionMeter {
 public:
  // Requires a skeleton that Validate accepts, with a head and limbs (possible()).
  explicit ReactionMeter(const motion::Skeleton& skeleton);
  bool possible() const;

  // The frame in which a hand or foot of the leader reaches farthest towards the follower.
  int ActionFrame(const dataset::Sequence& sequence) const;
  // From 0.3 s before the action until 1 s after it.
  Amplitude Captured(const dataset::Sequence& sequence) const;
  // `follower` answers the sequence with `padding` more frames before and after it.
  Reaction Measure(const dataset::Sequence& sequence, const motion::Poses& follower,
                   int padding) const;

 private:
  Amplitude AmplitudeOf(const dataset::Sequence& sequence, const motion::Poses& follower) const;

  motion::Skeleton skeleton_;
  body::Body body_;
};

// The figures with and without padding with their intervals, and those of each class.
std::vector<report::Table> ReactionTables(const std::string& title,
                                          const std::vector<std::string>& classes,
                                          const std::vector<ReactionPair>& pairs);

}  // namespace duet::evaluation::experiments

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_REACTION_H_

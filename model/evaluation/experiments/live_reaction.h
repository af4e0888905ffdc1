#ifndef DUET_MODEL_EVALUATION_EXPERIMENTS_LIVE_REACTION_H_
#define DUET_MODEL_EVALUATION_EXPERIMENTS_LIVE_REACTION_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "absl/status/statusor.h"
#include "model/dataset/dataset.h"
#include "model/engine/synthesizer.h"

namespace duet::evaluation::experiments {

// How fast followers react to a leader who stands still for a while and then acts, and how smoothly
// they move.
struct LiveFigures {
  // From the moment at which the leader leaves the pose in which it stood by 5 cm, to that at which
  // the follower parts by 5 cm from a follower with the same seed whose leader goes on standing. Of
  // the clips in which it does.
  std::vector<double> reaction_seconds;
  // From a change of the label to another class, until the follower parts by 5 cm from one with the
  // old label.
  std::vector<double> label_seconds;
  int clips = 0;
  double speed = 0;  // mean of the joints, m/s
  double jerk = 0;   // mean of the joints, m/s^3
};

// The leader of every sequence at 30 frames per second, answered in its class. `live_delay`: see
// LabelledLeader. Errors: those of CheckModelFits; the network's.
absl::StatusOr<LiveFigures> MeasureLiveReaction(const engine::Synthesizer& synthesizer,
                                                const dataset::Dataset& dataset,
                                                const std::vector<int>& sequences, uint64_t seed,
                                                std::optional<int> live_delay);

// The same times for the captured followers: from the leader's departure to the follower's, both
// from their first poses and filtered against noise. Shapes: at most one for each sequence.
std::vector<double> CapturedReactions(const dataset::Dataset& dataset,
                                      const std::vector<int>& sequences);

}  // namespace duet::evaluation::experiments

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_LIVE_REACTION_H_

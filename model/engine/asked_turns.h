#ifndef DUET_MODEL_ENGINE_ASKED_TURNS_H_
#define DUET_MODEL_ENGINE_ASKED_TURNS_H_

#include <optional>
#include <vector>

#include "model/engine/model_description.h"
#include "model/engine/network.h"
#include "model/engine/synthesizer.h"
#include "model/motion/poses.h"
#include "model/motion/skeleton.h"

namespace duet::engine {

// The turns of the follower that the labels of a window ask for (a positive weight of one of
// ModelDescription::turning_classes) or avoid (a negative one). Judged are the frames between the
// settled ones and the lookahead.
class AskedTurns {
 public:
  AskedTurns(const ModelDescription& description, const SynthesisWindow& window);

  // The mean size of the weights, 0 to 1. 0 if the labels say nothing about turns, or too little
  // to be judged.
  double demand() const { return demand_; }

  // How far a follower is from doing what the labels say: 0 if it does, at most demand() for a
  // follower that does not turn where it should, and above if it turns against the labels. Shapes:
  // follower as the window's leader.
  double Miss(const motion::Poses& leader, const motion::Poses& follower) const;

 private:
  int root_ = 0;
  motion::JointPair hips_;
  int first_ = 0;                   // of the frames that are judged
  std::vector<double> wanted_;      // degrees per frame; below 0 where turns are avoided
  double asked_ = 0, avoided_ = 0;  // their sums
  double share_asked_ = 0, share_avoided_ = 0;
  double demand_ = 0;
};

// A miss of at most this share of the demand is not worth more samples.
inline constexpr double kToleratedMiss = 0.1;

// The inputs of more samples of a window: up to seven, the more the labels demand, with other
// seeds and with labels of turns that are enlarged by up to four, because the network gives them
// less weight than its leader. `input`: of the window's first sample.
std::vector<NetworkInput> DrawnAgain(const ModelDescription& description, const AskedTurns& turns,
                                     const SynthesisWindow& window, const NetworkInput& input);

// Finds out from captured pairs of one class whether its followers turn about themselves, and how
// fast: seen from the leader, by more than half a turn and in one direction.
class TurningFit {
 public:
  // `skeleton` must outlive the fit.
  explicit TurningFit(const motion::Skeleton& skeleton) : skeleton_(skeleton) {}

  // Adds one stretch of the class: frames [begin, end) of a pair.
  void Add(const motion::Poses& leader, const motion::Poses& follower, int begin, int end);

  // The median speed. Absent for fewer than three stretches, if half of them turn by less than 230
  // degrees, or without hips.
  std::optional<double> DegreesPerSecond(double frame_rate_hz) const;

 private:
  const motion::Skeleton& skeleton_;
  std::vector<double> degrees_, per_frame_;  // of every stretch
};

}  // namespace duet::engine

#endif  // DUET_MODEL_ENGINE_ASKED_TURNS_H_

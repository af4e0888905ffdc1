#ifndef DUET_MODEL_EVALUATION_EXPERIMENTS_TURN_LABELS_H_
#define DUET_MODEL_EVALUATION_EXPERIMENTS_TURN_LABELS_H_

#include <vector>

#include "model/dataset/dataset.h"
#include "model/engine/label_track.h"
#include "model/evaluation/metrics/dance.h"

// Whether the label of a turn decides that a follower turns, with the lead and against it.

namespace duet::evaluation::experiments {

// Frames [begin, end) of a take.
struct FrameSpan {
  int begin = 0;
  int end = 0;
};

// The frames of a take with the label of a turn, and the frames without it, cut into stretches of
// four seconds; shorter remainders belong to neither.
struct TurnStretches {
  std::vector<FrameSpan> led;      // the lead asks for a turn
  std::vector<FrameSpan> not_led;  // it does not
};
TurnStretches FindTurnStretches(const dataset::Sequence& take, int turn_class,
                                double frame_rate_hz);

// The labels of the take's time line, except that in the stretches the turn has the weight `weight`
// and all other classes have 0.
engine::LabelTrack LabelsWithTurn(const dataset::Sequence& take, int classes, int turn_class,
                                  const std::vector<FrameSpan>& stretches, double weight);

// Number of stretches in which a turn has its middle.
int CountTurned(const std::vector<FrameSpan>& stretches, const std::vector<metrics::Turn>& turns,
                double frame_rate_hz);

}  // namespace duet::evaluation::experiments

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_TURN_LABELS_H_

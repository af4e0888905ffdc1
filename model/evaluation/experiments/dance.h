#ifndef DUET_MODEL_EVALUATION_EXPERIMENTS_DANCE_H_
#define DUET_MODEL_EVALUATION_EXPERIMENTS_DANCE_H_

#include <string>
#include <vector>

#include "model/body/dance.h"
#include "model/dataset/dataset.h"
#include "model/engine/label_track.h"
#include "model/evaluation/report/table.h"
#include "model/motion/poses.h"

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
int CountTurned(const std::vector<FrameSpan>& stretches, const std::vector<body::Turn>& turns,
                double frame_rate_hz);

// The figures of a follower who dances, and their table.

// A row of the table: a way to answer takes, and the figures of its followers of all takes.
// Shapes: takes [takes][columns].
struct DanceRow {
  std::string name;
  std::vector<std::vector<double>> takes;
};

// The figures of one follower, in the order of the table's columns. `captured` is null if the
// follower answers nothing that was captured; figures that compare with it are then NaN.
std::vector<double> MeasureDance(const dataset::Dataset& dataset, const body::DanceJoints& joints,
                                 const motion::Poses& leader, const motion::Poses& follower,
                                 const motion::Poses* captured);

// Means over the takes, ignoring NaN, with notes that explain the columns.
report::Table DanceTable(std::string title, const std::vector<DanceRow>& rows);

}  // namespace duet::evaluation::experiments

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_DANCE_H_

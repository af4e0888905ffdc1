#ifndef DUET_MODEL_EVALUATION_PROGRAM_DANCE_FIGURES_H_
#define DUET_MODEL_EVALUATION_PROGRAM_DANCE_FIGURES_H_

#include <string>
#include <vector>

#include "model/dataset/dataset.h"
#include "model/evaluation/metrics/dance.h"
#include "model/evaluation/report/table.h"
#include "model/motion/poses.h"

// The figures of a follower who dances, and their table.

namespace duet::evaluation::program {

// A row of the table: a way to answer takes, and the figures of its followers of all takes.
// Shapes: takes [takes][columns].
struct DanceRow {
  std::string name;
  std::vector<std::vector<double>> takes;
};

// The figures of one follower, in the order of the table's columns. `captured` is null if the
// follower answers nothing that was captured; figures that compare with it are then NaN.
std::vector<double> MeasureDance(const dataset::Dataset& dataset,
                                 const metrics::DanceJoints& joints, const motion::Poses& leader,
                                 const motion::Poses& follower, const motion::Poses* captured);

// The mean of each column, ignoring NaN. Shapes: rows [rows][columns]; returns [columns].
std::vector<double> ColumnMeans(const std::vector<std::vector<double>>& rows);

// Means over the takes, ignoring NaN, with notes that explain the columns.
report::Table DanceTable(std::string title, const std::vector<DanceRow>& rows);

}  // namespace duet::evaluation::program

#endif  // DUET_MODEL_EVALUATION_PROGRAM_DANCE_FIGURES_H_

#ifndef DUET_MODEL_EVALUATION_REPORT_DATA_TABLES_H_
#define DUET_MODEL_EVALUATION_REPORT_DATA_TABLES_H_

#include "model/dataset/dataset.h"
#include "model/evaluation/report/table.h"

// Properties of a data set.

namespace duet::evaluation::report {

// The mean lean of leaders and followers towards +x and +z, degrees, as captured and level: a row
// for each set and one for all.
Table LeanTable(const dataset::Dataset& dataset);

// The lean of a plane through the lower feet (degrees), and the lower quartile of their height
// (centimetres), as captured and level: the same rows.
Table FloorTable(const dataset::Dataset& dataset);

// How many joints of frames motion::RepairJumps moves, and the jitter (m/s^3) of both people as
// captured, repaired, and after an additional Gaussian of one frame: a row for each class and one
// for all.
Table NoiseTable(const dataset::Dataset& dataset);

// The source of the leader's side, and how often the motion rule agrees with a side in the index: a
// row for each class and one for all. In a symmetric class either may lead.
Table LeaderTable(const dataset::Dataset& dataset);

// What the solver (model/solver) does to captured followers, which hardly need it: a row for them
// as captured, and one for them as solved. Columns: the share of frames in which a joint moves by
// more than a centimetre (percent), the movement of joints (mean and 99th percentile, centimetres),
// foot slide (centimetres per frame) and the deepest overlap with the leader (centimetres, mean
// over sequences). Each sequence is one window; contact is allowed in classes that touch.
Table SolverTable(const dataset::Dataset& dataset);

}  // namespace duet::evaluation::report

#endif  // DUET_MODEL_EVALUATION_REPORT_DATA_TABLES_H_

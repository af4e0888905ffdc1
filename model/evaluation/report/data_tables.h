#ifndef DUET_MODEL_EVALUATION_REPORT_DATA_TABLES_H_
#define DUET_MODEL_EVALUATION_REPORT_DATA_TABLES_H_

#include "model/dataset/dataset.h"
#include "model/evaluation/report/table.h"

// What a data set is like before anybody learns from it.

namespace duet::evaluation::report {

// The mean lean of leaders and followers towards +x and +z, degrees, as captured and level: a row
// for each set and one for all.
Table LeanTable(const dataset::Dataset& dataset);

// The lean of a plane through the lower feet (degrees), and how high a quarter of them is at most
// (centimetres), as captured and level: the same rows.
Table FloorTable(const dataset::Dataset& dataset);

// How many joints of frames motion::RepairJumps moves, and the jitter (m/s^3) of both people as
// captured, so repaired, and after a Gaussian of one frame besides: a row for each class and one
// for all.
Table NoiseTable(const dataset::Dataset& dataset);

// Where the leader's side comes from, and how often the motion rule names the leader that the index
// names without guessing: a row for each class and one for all. In a symmetric class either may
// lead.
Table LeaderTable(const dataset::Dataset& dataset);

}  // namespace duet::evaluation::report

#endif  // DUET_MODEL_EVALUATION_REPORT_DATA_TABLES_H_

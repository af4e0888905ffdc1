#ifndef DUET_MODEL_EVALUATION_REPORT_CLEAN_UP_TABLE_H_
#define DUET_MODEL_EVALUATION_REPORT_CLEAN_UP_TABLE_H_

#include "model/dataset/dataset.h"
#include "model/evaluation/report/table.h"

namespace duet::evaluation::report {

// What clean-up (model/cleanup) does to captured followers, which need none: a row for them as
// captured, for each stage alone, and for all. Columns: the share of frames in which a joint moves
// by more than a centimetre (percent), how far joints move (mean and 99th percentile, centimetres),
// foot slide (centimetres a frame) and the deepest overlap with the leader (centimetres, mean over
// sequences). Each sequence is one window; in classes that touch, bodies do as they like.
Table CleanUpTable(const dataset::Dataset& dataset);

}  // namespace duet::evaluation::report

#endif  // DUET_MODEL_EVALUATION_REPORT_CLEAN_UP_TABLE_H_

#ifndef DUET_MODEL_EVALUATION_REPORT_CLEAN_UP_TABLE_H_
#define DUET_MODEL_EVALUATION_REPORT_CLEAN_UP_TABLE_H_

#include "model/dataset/dataset.h"
#include "model/evaluation/report/table.h"

namespace duet::evaluation::report {

// The effect of clean-up (model/cleanup) on captured followers, which need none: rows for them as
// captured, for each single stage, and for all stages. Columns: the share of frames in which a
// joint moves by more than a centimetre (percent), the movement of joints (mean and 99th
// percentile, centimetres), foot slide (centimetres per frame) and the deepest overlap with the
// leader (centimetres, mean over sequences). Each sequence is one window; contact is allowed in
// classes that touch.
Table CleanUpTable(const dataset::Dataset& dataset);

}  // namespace duet::evaluation::report

#endif  // DUET_MODEL_EVALUATION_REPORT_CLEAN_UP_TABLE_H_

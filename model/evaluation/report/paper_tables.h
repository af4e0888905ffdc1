#ifndef DUET_MODEL_EVALUATION_REPORT_PAPER_TABLES_H_
#define DUET_MODEL_EVALUATION_REPORT_PAPER_TABLES_H_

#include "model/evaluation/report/table.h"

namespace duet::evaluation::report {

// The figures printed by Goel et al. 2022. Every row is marked as printed; a note of each table
// says what it is comparable with. Columns have this project's class names.

Table PaperAfdSbu();        // Tables 1 and 4: average frame distance on SBU
Table PaperFidSbu();        // Table 2
Table PaperAugmentation();  // Table 6: a classifier's accuracy without and with synthetic motion

}  // namespace duet::evaluation::report

#endif  // DUET_MODEL_EVALUATION_REPORT_PAPER_TABLES_H_

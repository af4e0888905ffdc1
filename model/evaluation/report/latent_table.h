#ifndef DUET_MODEL_EVALUATION_REPORT_LATENT_TABLE_H_
#define DUET_MODEL_EVALUATION_REPORT_LATENT_TABLE_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "model/evaluation/metrics/features.h"
#include "model/evaluation/report/table.h"

namespace duet::evaluation::report {

// How well the classes of a latent space keep together: a table without rows, and the row of one
// space. Shapes: features and classes [samples].
// Errors: those of NeighbourAccuracy.
Table LatentTable();
absl::StatusOr<TableRow> LatentRow(const std::string& name, const metrics::FeatureSet& features,
                                   const std::vector<int>& classes);

}  // namespace duet::evaluation::report

#endif  // DUET_MODEL_EVALUATION_REPORT_LATENT_TABLE_H_

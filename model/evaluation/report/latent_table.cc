#include "model/evaluation/report/latent_table.h"

#include "absl/strings/str_cat.h"
#include "model/evaluation/metrics/neighbours.h"

namespace duet::evaluation::report {
namespace {

constexpr int kNeighbours[] = {1, 5};

}  // namespace

Table LatentTable() {
  Table table;
  table.title = "Share of clips whose nearest neighbours are of their class";
  for (const int count : kNeighbours) table.columns.push_back(absl::StrCat(count, " in the space"));
  table.decimals = 3;
  return table;
}

absl::StatusOr<TableRow> LatentRow(const std::string& name, const metrics::FeatureSet& features,
                                   const std::vector<int>& classes) {
  TableRow row = {name, {}};
  for (const int count : kNeighbours) {
    absl::StatusOr<double> accuracy = metrics::NeighbourAccuracy(features, classes, count);
    if (!accuracy.ok()) return accuracy.status();
    row.values.push_back(*accuracy);
  }
  return row;
}

}  // namespace duet::evaluation::report

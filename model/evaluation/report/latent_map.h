#ifndef DUET_MODEL_EVALUATION_REPORT_LATENT_MAP_H_
#define DUET_MODEL_EVALUATION_REPORT_LATENT_MAP_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "model/evaluation/metrics/features.h"
#include "model/evaluation/metrics/tsne.h"
#include "model/evaluation/report/plot.h"

namespace duet::evaluation::report {

// A space of features as it is shown and measured.
struct LatentMap {
  std::vector<metrics::Point2> points;  // t-SNE
  double purity_of_map = 0;             // NeighbourPurity of the points
  double nearest_neighbour = 0;         // NeighbourAccuracy in the space itself, of 1
  double several_neighbours = 0;        // and of kLatentNeighbours
};

inline constexpr int kLatentNeighbours = 5;

// The perplexity is lowered to what the number of samples allows. Shapes: features and classes
// [samples]. Errors: those of Tsne and NeighbourAccuracy.
absl::StatusOr<LatentMap> MapLatent(const metrics::FeatureSet& features,
                                    const std::vector<int>& classes, metrics::TsneOptions options);

// The map by class; a class without points keeps its colour and its place in the legend.
ScatterPlot PlotByClass(std::string title, const std::vector<std::string>& class_names,
                        const std::vector<metrics::Point2>& points,
                        const std::vector<int>& classes);

}  // namespace duet::evaluation::report

#endif  // DUET_MODEL_EVALUATION_REPORT_LATENT_MAP_H_

#include "model/evaluation/report/latent_map.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "model/evaluation/metrics/neighbours.h"

namespace duet::evaluation::report {

absl::StatusOr<LatentMap> MapLatent(const metrics::FeatureSet& features,
                                    const std::vector<int>& classes, metrics::TsneOptions options) {
  LatentMap map;
  absl::StatusOr<double> accuracy = metrics::NeighbourAccuracy(features, classes, 1);
  if (!accuracy.ok()) return accuracy.status();
  map.nearest_neighbour = *accuracy;
  accuracy = metrics::NeighbourAccuracy(features, classes, kLatentNeighbours);
  if (!accuracy.ok()) return accuracy.status();
  map.several_neighbours = *accuracy;
  options.perplexity = std::min(options.perplexity, (static_cast<double>(features.size()) - 1) / 3);
  absl::StatusOr<std::vector<metrics::Point2>> points = Tsne(features, options);
  if (!points.ok()) return points.status();
  map.points = *std::move(points);
  map.purity_of_map = metrics::NeighbourPurity(map.points, classes);
  return map;
}

ScatterPlot PlotByClass(std::string title, const std::vector<std::string>& class_names,
                        const std::vector<metrics::Point2>& points,
                        const std::vector<int>& classes) {
  ScatterPlot plot{std::move(title), {}};
  for (const std::string& name : class_names) plot.series.push_back({name, {}});
  for (size_t i = 0; i < points.size(); ++i) {
    plot.series[static_cast<size_t>(classes[i])].points.push_back(points[i]);
  }
  return plot;
}

}  // namespace duet::evaluation::report

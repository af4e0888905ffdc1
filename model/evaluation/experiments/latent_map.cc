#include "model/evaluation/experiments/latent_map.h"

#include <algorithm>
#include <utility>

#include "model/evaluation/metrics/neighbours.h"

namespace duet::evaluation::experiments {

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

}  // namespace duet::evaluation::experiments

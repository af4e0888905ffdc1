#ifndef DUET_MODEL_EVALUATION_EXPERIMENTS_LATENT_MAP_H_
#define DUET_MODEL_EVALUATION_EXPERIMENTS_LATENT_MAP_H_

#include <vector>

#include "absl/status/statusor.h"
#include "model/evaluation/metrics/features.h"
#include "model/evaluation/metrics/tsne.h"

namespace duet::evaluation::experiments {

// A map of a space of features, and how well the classes keep together in the map and in the space.
struct LatentMap {
  std::vector<metrics::Point2> points;  // t-SNE
  double purity_of_map = 0;             // NeighbourPurity of the points
  double nearest_neighbour = 0;         // NeighbourAccuracy in the space: of the nearest neighbour
  double several_neighbours = 0;        // and of the kLatentNeighbours nearest ones
};

inline constexpr int kLatentNeighbours = 5;

// The perplexity is lowered to what the number of samples allows. Shapes: features and classes
// [samples]. Errors: those of Tsne and NeighbourAccuracy.
absl::StatusOr<LatentMap> MapLatent(const metrics::FeatureSet& features,
                                    const std::vector<int>& classes, metrics::TsneOptions options);

}  // namespace duet::evaluation::experiments

#endif  // DUET_MODEL_EVALUATION_EXPERIMENTS_LATENT_MAP_H_

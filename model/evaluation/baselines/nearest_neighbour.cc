#include "model/evaluation/baselines/nearest_neighbour.h"

#include <limits>
#include <utility>

namespace duet::evaluation::baselines {
namespace {

// A matching's cost so far and its number of matched rows.
struct Path {
  double cost = std::numeric_limits<double>::infinity();
  int length = 0;
};

const Path& Cheapest(const Path& a, const Path& b, const Path& c) {
  const Path& ab = a.cost <= b.cost ? a : b;
  return ab.cost <= c.cost ? ab : c;
}

}  // namespace

double TimeWarpedDistance(const Rows& a, const Rows& b) {
  const size_t width = static_cast<size_t>(b.rows());
  // One row of the table at a time; index 0 stands for "before the first row of b".
  std::vector<Path> previous(width + 1), current(width + 1);
  previous[0].cost = 0;
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    current[0] = Path{};
    for (size_t j = 1; j <= width; ++j) {
      const Path& from = Cheapest(previous[j - 1], previous[j], current[j - 1]);
      const double distance = (a.row(i) - b.row(static_cast<Eigen::Index>(j) - 1)).norm();
      current[j] = {from.cost + distance, from.length + 1};
    }
    std::swap(previous, current);
  }
  return previous[width].cost / previous[width].length;
}

void NearestNeighbour::TrainClass(int interaction_class, const std::vector<StandardPair>& pairs) {
  pairs_[static_cast<size_t>(interaction_class)] = pairs;
}

Rows NearestNeighbour::PredictClass(int interaction_class, const StandardPair& leader) const {
  const std::vector<StandardPair>& pairs = pairs_[static_cast<size_t>(interaction_class)];
  const StandardPair* nearest = nullptr;
  double best = std::numeric_limits<double>::infinity();
  for (const StandardPair& pair : pairs) {
    const double distance = TimeWarpedDistance(leader.leader, pair.leader);
    if (nearest != nullptr && distance >= best) continue;
    best = distance;
    nearest = &pair;
  }
  return StretchTo(nearest->follower, leader.leader.rows());
}

}  // namespace duet::evaluation::baselines

#include "model/evaluation/baselines/kmeans.h"

#include <limits>

#include "model/evaluation/baselines/sample_index.h"

namespace duet::evaluation::baselines {
namespace {

constexpr int kMaxIterations = 100;

// Picks rows with probability proportional to the squared distance to those picked before.
Rows Seeds(const Rows& rows, int clusters, base::Random* random) {
  Rows centres(clusters, rows.cols());
  Eigen::VectorXd nearest =
      Eigen::VectorXd::Constant(rows.rows(), std::numeric_limits<double>::infinity());
  Eigen::Index pick =
      static_cast<Eigen::Index>(random->Uniform() * static_cast<double>(rows.rows()));
  int count = 0;
  for (; count < clusters; ++count) {
    centres.row(count) = rows.row(pick);
    nearest = nearest.cwiseMin((rows.rowwise() - centres.row(count)).rowwise().squaredNorm());
    if (nearest.sum() <= 0) {
      ++count;
      break;
    }
    pick = SampleIndex(nearest, random);
  }
  return centres.topRows(count);
}

}  // namespace

int NearestCentre(const Rows& centres, const Eigen::RowVectorXd& row) {
  Eigen::Index nearest = 0;
  (centres.rowwise() - row).rowwise().squaredNorm().minCoeff(&nearest);
  return static_cast<int>(nearest);
}

std::vector<int> NearestCentres(const Rows& centres, const Rows& rows) {
  std::vector<int> nearest;
  nearest.reserve(static_cast<size_t>(rows.rows()));
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    nearest.push_back(NearestCentre(centres, rows.row(i)));
  }
  return nearest;
}

Rows KMeans(const Rows& rows, int clusters, uint64_t seed) {
  base::Random random(seed);
  Rows centres = Seeds(rows, clusters, &random);
  std::vector<int> members;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    std::vector<int> nearest = NearestCentres(centres, rows);
    if (nearest == members) break;
    members = std::move(nearest);
    Rows sums = Rows::Zero(centres.rows(), centres.cols());
    Eigen::VectorXd counts = Eigen::VectorXd::Zero(centres.rows());
    for (Eigen::Index i = 0; i < rows.rows(); ++i) {
      const int centre = members[static_cast<size_t>(i)];
      sums.row(centre) += rows.row(i);
      counts(centre) += 1;
    }
    // A centre that lost all its rows stays where it was.
    for (Eigen::Index c = 0; c < centres.rows(); ++c) {
      if (counts(c) > 0) centres.row(c) = sums.row(c) / counts(c);
    }
  }
  return centres;
}

}  // namespace duet::evaluation::baselines

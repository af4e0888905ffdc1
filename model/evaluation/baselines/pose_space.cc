#include "model/evaluation/baselines/pose_space.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace duet::evaluation::baselines {
namespace {

// Components with less than this share of the strongest one's variance are rounding.
constexpr double kNoVariance = 1e-10;

Rows Stack(const std::vector<StandardPair>& pairs, Rows StandardPair::*part) {
  std::vector<const Rows*> parts;
  for (const StandardPair& pair : pairs) parts.push_back(&(pair.*part));
  return StackRows(parts);
}

}  // namespace

PoseSpace::PoseSpace(const Rows& rows, Eigen::Index dimensions) : mean_(rows.colwise().mean()) {
  const Rows centred = rows.rowwise() - mean_;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(centred.transpose() * centred);
  const Eigen::VectorXd& variance = solver.eigenvalues();  // ascending
  const Eigen::Index values = rows.cols();
  const double least = kNoVariance * std::max(variance(values - 1), 0.0);
  Eigen::Index kept = std::min(dimensions, values);
  while (kept > 1 && variance(values - kept) <= least) --kept;
  basis_ = solver.eigenvectors().rightCols(kept).rowwise().reverse();
}

Rows PoseSpace::Project(const Rows& rows) const { return (rows.rowwise() - mean_) * basis_; }

Rows PoseSpace::Reconstruct(const Rows& components) const {
  return (components * basis_.transpose()).rowwise() + mean_;
}

Rows StackRows(const std::vector<const Rows*>& parts) {
  Eigen::Index rows = 0;
  for (const Rows* part : parts) rows += part->rows();
  Rows stacked(rows, parts.front()->cols());
  rows = 0;
  for (const Rows* part : parts) {
    stacked.middleRows(rows, part->rows()) = *part;
    rows += part->rows();
  }
  return stacked;
}

Rows StackCues(const std::vector<StandardPair>& pairs) { return Stack(pairs, &StandardPair::cues); }

Rows StackFollowers(const std::vector<StandardPair>& pairs) {
  return Stack(pairs, &StandardPair::follower);
}

}  // namespace duet::evaluation::baselines

#ifndef DUET_MODEL_EVALUATION_BASELINES_POSE_SPACE_H_
#define DUET_MODEL_EVALUATION_BASELINES_POSE_SPACE_H_

#include <vector>

#include "model/evaluation/baselines/motion_matrix.h"

namespace duet::evaluation::baselines {

// The principal components of a set of rows.
class PoseSpace {
 public:
  PoseSpace() = default;
  // Fits at most `dimensions` components, fewer if the rows span fewer. Requires at least one row.
  PoseSpace(const Rows& rows, Eigen::Index dimensions);

  Eigen::Index dimensions() const { return basis_.cols(); }
  // Shapes: [n, values] to [n, dimensions] and back.
  Rows Project(const Rows& rows) const;
  Rows Reconstruct(const Rows& components) const;

 private:
  Eigen::RowVectorXd mean_;
  Eigen::MatrixXd basis_;  // [values, dimensions], orthonormal columns, strongest first
};

// Rows of several matrices with the same number of columns, one below the other. Requires at least
// one matrix.
Rows StackRows(const std::vector<const Rows*>& parts);

// The cues, or the followers, of pairs, one below the other. Requires at least one pair.
Rows StackCues(const std::vector<StandardPair>& pairs);
Rows StackFollowers(const std::vector<StandardPair>& pairs);

}  // namespace duet::evaluation::baselines

#endif  // DUET_MODEL_EVALUATION_BASELINES_POSE_SPACE_H_

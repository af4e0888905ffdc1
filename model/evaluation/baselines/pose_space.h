#ifndef DUET_MODEL_EVALUATION_BASELINES_POSE_SPACE_H_
#define DUET_MODEL_EVALUATION_BASELINES_POSE_SPACE_H_

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

// Rows of several matrices, one below the other. `get` picks the matrix of an element.
template <typename Elements, typename Get>
Rows StackRows(const Elements& elements, Get get) {
  Eigen::Index rows = 0;
  for (const auto& element : elements) rows += get(element).rows();
  Rows out(rows, get(*elements.begin()).cols());
  rows = 0;
  for (const auto& element : elements) {
    out.middleRows(rows, get(element).rows()) = get(element);
    rows += get(element).rows();
  }
  return out;
}

}  // namespace duet::evaluation::baselines

#endif  // DUET_MODEL_EVALUATION_BASELINES_POSE_SPACE_H_

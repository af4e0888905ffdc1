#include "model/formats/research/smpl_body.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "model/formats/research/body_joints.h"
#include "model/formats/research/npz_numbers.h"
#include "model/motion/motion_limits.h"

namespace duet::formats::research {
namespace {

using retargeting::Vec3d;

// Some tables have 2^32 - 1 for no parent.
constexpr double kMostParent = 1e10;

// Vertices of a body, three numbers each.
using Vertices = std::vector<double>;

absl::StatusOr<Vertices> Template(const NpzArchive& model) {
  absl::StatusOr<NpzNumbers> vertices = ReadNumbers(model, "v_template");
  if (!vertices.ok()) return vertices.status();
  if (vertices->shape.size() != 2 || vertices->shape[0] < 1 || vertices->shape[1] != 3) {
    return WrongShape(*vertices, "(vertices, 3)");
  }
  return std::move(vertices->values);
}

absl::Status AddShape(const NpzArchive& model, absl::Span<const double> betas, Vertices* vertices) {
  if (std::all_of(betas.begin(), betas.end(), [](double beta) { return beta == 0; })) {
    return absl::OkStatus();
  }
  const absl::StatusOr<NpzNumbers> shapes = ReadNumbers(model, "shapedirs");
  if (!shapes.ok()) return shapes.status();
  const std::vector<int>& shape = shapes->shape;
  if (shape.size() != 3 || static_cast<std::size_t>(shape[0]) != vertices->size() / 3 ||
      shape[1] != 3) {
    return WrongShape(*shapes, absl::StrCat("(", vertices->size() / 3, ", 3, shapes)"));
  }
  const auto width = static_cast<std::size_t>(shape[2]);
  const std::size_t used = std::min(width, betas.size());
  for (std::size_t i = 0; i < vertices->size(); ++i) {
    for (std::size_t k = 0; k < used; ++k) {
      (*vertices)[i] += shapes->values[i * width + k] * betas[k];
    }
  }
  return absl::OkStatus();
}

absl::Status CheckParents(const NpzArchive& model) {
  const absl::StatusOr<NpzNumbers> table = ReadNumbers(model, "kintree_table", kMostParent);
  if (!table.ok()) return table.status();
  if (table->shape.size() != 2 || table->shape[0] != 2 || table->shape[1] < kBodyJoints) {
    return WrongShape(*table, "(2, joints) with at least 22 joints");
  }
  for (std::size_t joint = 1; joint < kBodyJoints; ++joint) {
    if (table->values[joint] == BodyParents()[joint]) continue;
    return absl::InvalidArgumentError(
        absl::StrCat(table->name, ": parent of joint ", joint, ": expected ", BodyParents()[joint],
                     " as in SMPL, SMPL+H and SMPL-X, got ", table->values[joint]));
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<BodyPose> RestJoints(const NpzArchive& model, absl::Span<const double> betas) {
  absl::StatusOr<Vertices> vertices = Template(model);
  if (!vertices.ok()) return vertices.status();
  absl::Status status = AddShape(model, betas, &*vertices);
  if (status.ok()) status = CheckParents(model);
  if (!status.ok()) return status;
  const absl::StatusOr<NpzNumbers> regressor = ReadNumbers(model, "J_regressor");
  if (!regressor.ok()) return regressor.status();
  const std::size_t count = vertices->size() / 3;
  if (regressor->shape.size() != 2 || regressor->shape[0] < kBodyJoints ||
      static_cast<std::size_t>(regressor->shape[1]) != count) {
    return WrongShape(*regressor, absl::StrCat("(joints, ", count, ") with at least 22 joints"));
  }
  BodyPose joints(kBodyJoints);
  for (std::size_t joint = 0; joint < kBodyJoints; ++joint) {
    for (std::size_t vertex = 0; vertex < count; ++vertex) {
      const double* const at = vertices->data() + 3 * vertex;
      joints[joint] += Vec3d{at[0], at[1], at[2]} * regressor->values[joint * count + vertex];
    }
  }
  for (const Vec3d& joint : joints) {
    if (Norm(joint) <= motion::kMaxCoordinate) continue;
    return absl::InvalidArgumentError(absl::StrCat(
        regressor->name, ": expected a body in metres, got a joint at ", Norm(joint), " m"));
  }
  return joints;
}

}  // namespace duet::formats::research

#include "model/retargeting/rest_rig.h"

#include <cstddef>
#include <string>

#include "absl/strings/str_cat.h"
#include "model/base/index.h"

namespace duet::retargeting {
namespace {

using base::Index;

}  // namespace

Quaternion ToWorldAxes(motion::UpAxis up_axis) {
  const motion::Coordinates file{motion::LengthUnit::kMetres, up_axis};
  const auto in_world = [&file](motion::Vec3 axis) { return ToDouble(ToWorld(file, axis)); };
  return FromAxes(in_world({1, 0, 0}), in_world({0, 1, 0}), in_world({0, 0, 1}));
}

CharacterRig RestRig(const JointTree& tree, const CharacterFit& fit) {
  const Quaternion to_world = ToWorldAxes(fit.up_axis);
  CharacterRig rig;
  rig.names = tree.names;
  rig.parents = tree.parents;
  rig.joints = fit.joints;
  for (std::size_t j = 0; j < tree.names.size(); ++j) {
    const int parent = tree.parents[j];
    const Vec3d offset = Rotate(to_world, tree.offsets[j]) * fit.metres_per_unit;
    rig.positions.push_back(parent < 0 ? Vec3d{} : rig.positions[Index(parent)] + offset);
    rig.moves.push_back(parent < 0);
  }
  return rig;
}

CharacterRig RestRig(const JointTree& tree, const CharacterFit& fit,
                     const std::vector<Vec3d>& positions) {
  const Quaternion to_world = ToWorldAxes(fit.up_axis);
  CharacterRig rig = RestRig(tree, fit);
  for (std::size_t j = 0; j < positions.size(); ++j) {
    const Vec3d from_root = positions[j] - positions[0];
    rig.positions[j] = Rotate(to_world, from_root) * fit.metres_per_unit;
  }
  return rig;
}

void NoteRestFrame(int frame, const CharacterOptions& options) {
  const std::string note =
      absl::StrCat("rest pose: that of frame ", frame,
                   ", because the bones of the rig at rest make no standing person");
  if (options.notes != nullptr) options.notes->push_back(note);
  if (options.report != nullptr) options.report->remarks.push_back(note);
}

LocalPose ToLocal(const CharacterRig& rig, const CharacterPose& pose) {
  LocalPose local;
  for (std::size_t j = 0; j < rig.names.size(); ++j) {
    const int parent = rig.parents[j];
    const Quaternion from_parent = parent < 0 ? Quaternion{} : Inverse(pose.turns[Index(parent)]);
    const Vec3d parent_at = parent < 0 ? Vec3d{} : pose.positions[Index(parent)];
    local.turns.push_back(from_parent * pose.turns[j]);
    local.places.push_back(Rotate(from_parent, pose.positions[j] - parent_at));
  }
  return local;
}

std::vector<int> DepthFirst(const std::vector<int>& parents) {
  std::vector<std::vector<int>> children(parents.size());
  std::vector<int> waiting;  // a stack
  for (std::size_t j = parents.size(); j-- > 0;) {
    if (parents[j] < 0) {
      waiting.push_back(static_cast<int>(j));
    } else {
      children[Index(parents[j])].push_back(static_cast<int>(j));
    }
  }
  std::vector<int> order;
  while (!waiting.empty()) {
    const int joint = waiting.back();
    waiting.pop_back();
    order.push_back(joint);
    // Children were pushed in reverse order, so that the first one is next.
    const std::vector<int>& below = children[Index(joint)];
    waiting.insert(waiting.end(), below.begin(), below.end());
  }
  return order;
}

}  // namespace duet::retargeting

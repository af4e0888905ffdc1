#include "model/motion/limb_lengths.h"

#include <algorithm>
#include <cstddef>

namespace duet::motion {
std::vector<float> MedianBoneLengths(const Skeleton& skeleton, const std::vector<Vec3>& positions) {
  const std::size_t joints = skeleton.joint_names.size(), frames = positions.size() / joints;
  std::vector<float> medians;
  std::vector<float> lengths(frames);
  for (const Bone& bone : skeleton.bones) {
    for (std::size_t t = 0; t < frames; ++t) {
      const Vec3* pose = positions.data() + t * joints;
      lengths[t] = Distance(pose[bone.parent], pose[bone.child]);
    }
    const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(frames / 2);
    std::nth_element(lengths.begin(), middle, lengths.end());
    medians.push_back(*middle);
  }
  return medians;
}

void SetBoneLengths(const Skeleton& skeleton, const std::vector<float>& lengths,
                    std::vector<Vec3>* positions) {
  const std::size_t joints = skeleton.joint_names.size();
  const std::vector<int> order = BonesFromRoot(skeleton);
  std::vector<Vec3> before(joints);
  for (auto pose = positions->begin(); pose != positions->end();
       pose += static_cast<std::ptrdiff_t>(joints)) {
    std::copy_n(pose, joints, before.begin());
    for (const int index : order) {
      const std::size_t b = static_cast<std::size_t>(index);
      const std::size_t parent = static_cast<std::size_t>(skeleton.bones[b].parent);
      const std::size_t child = static_cast<std::size_t>(skeleton.bones[b].child);
      const Vec3 along = before[child] - before[parent];
      const float length = Norm(along);
      const Vec3 offset = length > 0 ? along * (lengths[b] / length) : along;
      pose[static_cast<std::ptrdiff_t>(child)] = pose[static_cast<std::ptrdiff_t>(parent)] + offset;
    }
  }
}

}  // namespace duet::motion

#include "model/motion/limb_lengths.h"

#include <algorithm>
#include <cstddef>

namespace duet::motion {

std::vector<float> MedianBoneLengths(const Skeleton& skeleton, const Poses& poses) {
  std::vector<float> medians;
  std::vector<float> lengths(static_cast<std::size_t>(poses.frame_count()));
  for (const Bone& bone : skeleton.bones) {
    for (int t = 0; t < poses.frame_count(); ++t) {
      lengths[static_cast<std::size_t>(t)] =
          Distance(poses.at(t, bone.parent), poses.at(t, bone.child));
    }
    const auto middle = lengths.begin() + poses.frame_count() / 2;
    std::nth_element(lengths.begin(), middle, lengths.end());
    medians.push_back(*middle);
  }
  return medians;
}

void SetBoneLengths(const Skeleton& skeleton, const std::vector<float>& lengths, Poses* poses) {
  const std::vector<int> order = BonesFromRoot(skeleton);
  const Poses before = *poses;
  for (int t = 0; t < poses->frame_count(); ++t) {
    for (const int index : order) {
      const Bone& bone = skeleton.bones[static_cast<std::size_t>(index)];
      const Vec3 along = before.at(t, bone.child) - before.at(t, bone.parent);
      const float length = Norm(along);
      const float target = lengths[static_cast<std::size_t>(index)];
      const Vec3 offset = length > 0 ? along * (target / length) : along;
      poses->at(t, bone.child) = poses->at(t, bone.parent) + offset;
    }
  }
}

}  // namespace duet::motion

#include "model/engine/cross_fade.h"

#include <cstddef>

namespace duet::engine {
namespace {

// Below this share of the wanted length a blended bone has no direction to speak of.
constexpr float kLeastDirection = 0.1f;

// 0 to 1 with level ends.
float SmoothStep(float t) { return t * t * (3 - 2 * t); }

motion::Vec3 BlendBone(motion::Vec3 a, motion::Vec3 b, float weight) {
  const motion::Vec3 average = Lerp(a, b, weight);
  const float length = Norm(average);
  const float wanted = Norm(a) + (Norm(b) - Norm(a)) * weight;
  return length > kLeastDirection * wanted ? average * (wanted / length) : average;
}

std::vector<motion::Bone> ParentsFirst(const motion::Skeleton& skeleton) {
  std::vector<motion::Bone> ordered;
  for (const int bone : BonesFromRoot(skeleton)) {
    ordered.push_back(skeleton.bones[static_cast<std::size_t>(bone)]);
  }
  return ordered;
}

}  // namespace

CrossFade::CrossFade(const motion::Skeleton& skeleton)
    : joints_(skeleton.joint_count()), root_(skeleton.root), bones_(ParentsFirst(skeleton)) {}

void CrossFade::Blend(motion::Vec3* poses, const motion::Vec3* next, int frames) const {
  for (int t = 0; t < frames; ++t) {
    const float weight = SmoothStep(static_cast<float>(t + 1) / static_cast<float>(frames + 1));
    const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(t) * joints_;
    BlendPose(poses + row, next + row, weight);
  }
}

void CrossFade::BlendPose(motion::Vec3* pose, const motion::Vec3* next, float weight) const {
  const std::vector<motion::Vec3> from(pose, pose + joints_);
  pose[root_] = Lerp(from[static_cast<std::size_t>(root_)], next[root_], weight);
  for (const motion::Bone& bone : bones_) {
    const motion::Vec3 was =
        from[static_cast<std::size_t>(bone.child)] - from[static_cast<std::size_t>(bone.parent)];
    pose[bone.child] =
        pose[bone.parent] + BlendBone(was, next[bone.child] - next[bone.parent], weight);
  }
}

}  // namespace duet::engine

#include "model/engine/cross_fade.h"

#include <cstddef>

namespace duet {
namespace {

// Below this share of the wanted length a blended bone has no direction to speak of.
constexpr float kLeastDirection = 0.1f;

// 0 to 1 with level ends.
float SmoothStep(float t) { return t * t * (3 - 2 * t); }

Vec3 BlendBone(Vec3 a, Vec3 b, float weight) {
  const Vec3 average = Lerp(a, b, weight);
  const float length = Norm(average);
  const float wanted = Norm(a) + (Norm(b) - Norm(a)) * weight;
  return length > kLeastDirection * wanted ? average * (wanted / length) : average;
}

std::vector<Bone> ParentsFirst(const Skeleton& skeleton) {
  std::vector<Bone> ordered;
  for (const int bone : BonesFromRoot(skeleton)) {
    ordered.push_back(skeleton.bones[static_cast<std::size_t>(bone)]);
  }
  return ordered;
}

}  // namespace

CrossFade::CrossFade(const Skeleton& skeleton)
    : joints_(skeleton.joint_count()), root_(skeleton.root), bones_(ParentsFirst(skeleton)) {}

void CrossFade::Blend(Vec3* poses, const Vec3* next, int frames) const {
  for (int t = 0; t < frames; ++t) {
    const float weight = SmoothStep(static_cast<float>(t + 1) / static_cast<float>(frames + 1));
    const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(t) * joints_;
    BlendPose(poses + row, next + row, weight);
  }
}

void CrossFade::BlendPose(Vec3* pose, const Vec3* next, float weight) const {
  const std::vector<Vec3> from(pose, pose + joints_);
  pose[root_] = Lerp(from[static_cast<std::size_t>(root_)], next[root_], weight);
  for (const Bone& bone : bones_) {
    const Vec3 was =
        from[static_cast<std::size_t>(bone.child)] - from[static_cast<std::size_t>(bone.parent)];
    pose[bone.child] =
        pose[bone.parent] + BlendBone(was, next[bone.child] - next[bone.parent], weight);
  }
}

}  // namespace duet

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
    : root_(static_cast<std::size_t>(skeleton.root)), bones_(ParentsFirst(skeleton)) {}

void CrossFade::Blend(const motion::Poses& next, int first, motion::Poses* poses) const {
  const int frames = poses->frame_count() - first;
  for (int t = 0; t < frames; ++t) {
    const float weight = SmoothStep(static_cast<float>(t + 1) / static_cast<float>(frames + 1));
    BlendPose(next[t], weight, (*poses)[first + t]);
  }
}

void CrossFade::BlendPose(absl::Span<const motion::Vec3> next, float weight,
                          absl::Span<motion::Vec3> pose) const {
  const std::vector<motion::Vec3> from(pose.begin(), pose.end());
  pose[root_] = Lerp(from[root_], next[root_], weight);
  for (const motion::Bone& bone : bones_) {
    const std::size_t parent = static_cast<std::size_t>(bone.parent);
    const std::size_t child = static_cast<std::size_t>(bone.child);
    pose[child] =
        pose[parent] + BlendBone(from[child] - from[parent], next[child] - next[parent], weight);
  }
}

}  // namespace duet::engine

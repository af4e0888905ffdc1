#include "model/training/drift.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "model/base/angle.h"

namespace duet::training {
namespace {

using motion::Vec3;

using base::kPi;

Vec3 Horizontal(double angle) {
  return {static_cast<float>(std::cos(angle)), 0, static_cast<float>(std::sin(angle))};
}

Vec3 Normal3(double deviation, base::Random* random) {
  return {static_cast<float>(random->Normal(deviation)),
          static_cast<float>(random->Normal(deviation)),
          static_cast<float>(random->Normal(deviation))};
}

// True for the joints of the legs below the hips.
std::vector<bool> BelowHips(const motion::Skeleton& skeleton) {
  std::vector<bool> below(static_cast<size_t>(skeleton.joint_count()));
  if (!skeleton.hips) return below;
  for (const int b : BonesFromRoot(skeleton)) {
    const motion::Bone& bone = skeleton.bones[static_cast<size_t>(b)];
    below[static_cast<size_t>(bone.child)] = bone.parent == skeleton.hips->left ||
                                             bone.parent == skeleton.hips->right ||
                                             below[static_cast<size_t>(bone.parent)];
  }
  return below;
}

// One random error, applied in full or in part.
class Error {
 public:
  Error(const motion::Skeleton& skeleton, const FlowTraining::Drift& options, base::Random* random)
      : skeleton_(skeleton),
        below_hips_(BelowHips(skeleton)),
        tilt_axis_(Horizontal(random->Uniform(0, 2 * kPi))),
        bend_axis_(Horizontal(random->Uniform(0, 2 * kPi))),
        tilt_(random->Normal(options.tilt)),
        bend_(random->Normal(options.bend)),
        turn_(random->Normal(options.turn)),
        twist_(DrawTwist(options.twist, random)),
        moved_{static_cast<float>(random->Normal(options.root)),
               static_cast<float>(random->Normal(options.height)),
               static_cast<float>(random->Normal(options.root))} {
    for (int j = 0; j < skeleton.joint_count(); ++j) {
      joints_.push_back(Normal3(options.joints, random));
    }
  }

  // `share` 1 applies it in full. Shapes: pose [joints].
  void Apply(double share, absl::Span<Vec3> pose) const {
    if (skeleton_.hips) {
      Twist(share, pose);
      Bend(share, pose);
    }
    Vec3 pivot = pose[static_cast<size_t>(skeleton_.root)];
    for (const Vec3& joint : pose) pivot.y = std::min(pivot.y, joint.y);
    const float part = static_cast<float>(share);
    for (size_t j = 0; j < pose.size(); ++j) {
      const Vec3 tilted = RotateAbout(pose[j] - pivot, tilt_axis_, share * tilt_);
      pose[j] = pivot + RotateY(tilted, share * turn_) + part * (moved_ + joints_[j]);
    }
  }

 private:
  // Draws nothing for an error that is disabled, so that runs of version 1.0 can be repeated.
  static double DrawTwist(double deviation, base::Random* random) {
    return deviation > 0 ? random->Normal(deviation) : 0;
  }

  // Turns what is above the hips about the vertical through the root, the joint that joins it to
  // the hips, so that no limb changes its length.
  void Twist(double share, absl::Span<Vec3> pose) const {
    if (twist_ == 0) return;
    const Vec3 pivot = pose[static_cast<size_t>(skeleton_.root)];
    for (size_t j = 0; j < pose.size(); ++j) {
      const int joint = static_cast<int>(j);
      const bool hip = joint == skeleton_.hips->left || joint == skeleton_.hips->right;
      if (!hip && !below_hips_[j]) pose[j] = pivot + RotateY(pose[j] - pivot, share * twist_);
    }
  }

  void Bend(double share, absl::Span<Vec3> pose) const {
    const Vec3 pivot = Lerp(pose[static_cast<size_t>(skeleton_.hips->left)],
                            pose[static_cast<size_t>(skeleton_.hips->right)], 0.5f);
    for (size_t j = 0; j < pose.size(); ++j) {
      if (below_hips_[j]) continue;
      pose[j] = pivot + RotateAbout(pose[j] - pivot, bend_axis_, share * bend_);
    }
  }

  const motion::Skeleton& skeleton_;
  const std::vector<bool> below_hips_;
  const Vec3 tilt_axis_, bend_axis_;
  const double tilt_, bend_, turn_, twist_;
  const Vec3 moved_;
  std::vector<Vec3> joints_;
};

}  // namespace

void AddDrift(const motion::Skeleton& skeleton, const FlowTraining::Drift& options,
              base::Random* random, engine::NetworkInput* input, motion::Poses* target) {
  const Error error(skeleton, options, random);
  error.Apply(1, absl::MakeSpan(input->start->pose));
  input->start->root = input->start->pose[static_cast<size_t>(skeleton.root)];
  for (int t = 0; t < input->settled.frame_count(); ++t) error.Apply(1, input->settled[t]);
  const int told = std::max(1, input->settled.frame_count());
  for (int t = 0; t < target->frame_count(); ++t) {
    const double since =
        std::clamp((t - told + 1.0) / static_cast<double>(options.frames), 0.0, 1.0);
    const double share = 0.5 + 0.5 * std::cos(kPi * since);
    if (share > 0) error.Apply(share, (*target)[t]);
  }
}

}  // namespace duet::training

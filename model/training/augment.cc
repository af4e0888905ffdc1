#include "model/training/augment.h"

#include <algorithm>
#include <cmath>

#include "model/motion/resample.h"
#include "model/retargeting/anatomy.h"

namespace duet::training {
namespace {

constexpr int kMinCropFrames = 10;  // the length of the shortest captures

// Scales both people about the leader's root, each by its own factor. The distance between them
// therefore scales with the follower.
void ScaleBodies(int root, double leader_scale, double follower_scale, motion::ClipPair* pair) {
  const int joints = pair->leader.joint_count();
  for (int t = 0; t < pair->leader.frame_count(); ++t) {
    const motion::Vec3 centre = pair->leader.at(t, root);
    for (int j = 0; j < joints; ++j) {
      motion::Vec3& leader = pair->leader.at(t, j);
      motion::Vec3& follower = pair->follower.at(t, j);
      leader = centre + (leader - centre) * static_cast<float>(leader_scale);
      follower = centre + (follower - centre) * static_cast<float>(follower_scale);
    }
  }
}

void Turn(double radians, motion::ClipPair* pair) {
  for (motion::Vec3& point : pair->leader.poses.all()) point = RotateY(point, radians);
  for (motion::Vec3& point : pair->follower.poses.all()) point = RotateY(point, radians);
}

// Turns about the vertical through the root's position in the first frame. Captured hips face up to
// 30 degrees away from the partner; those of a clean leader do not.
void TurnLeader(int root, double radians, motion::Clip* leader) {
  const motion::Vec3 centre = leader->at(0, root);
  for (motion::Vec3& point : leader->poses.all()) point = centre + RotateY(point - centre, radians);
}

// Changes the build slightly, so that the network cannot recognise a clip by its leader's.
void AddBodyNoise(double deviation, base::Random* random, motion::Clip* clip) {
  std::vector<motion::Vec3> offsets(static_cast<size_t>(clip->joint_count()));
  for (motion::Vec3& offset : offsets) offset = Normal3(deviation, random);
  for (int t = 0; t < clip->frame_count(); ++t) {
    for (size_t j = 0; j < offsets.size(); ++j) clip->poses[t][j] += offsets[j];
  }
}

void AddNoise(double deviation, base::Random* random, motion::Clip* clip) {
  for (motion::Vec3& point : clip->poses.all()) point += Normal3(deviation, random);
}

// Frames [first, end) of the time line, as frames from `first`.
std::vector<dataset::LabelSpan> PartOf(const std::vector<dataset::LabelSpan>& labels, int first,
                                       int end) {
  std::vector<dataset::LabelSpan> kept;
  for (const dataset::LabelSpan& span : labels) {
    const int from = std::max(span.begin, first), to = std::min(span.end, end);
    if (from < to) kept.push_back({span.interaction_class, from - first, to - first});
  }
  return kept;
}

void Crop(base::Random* random, dataset::Sequence* sequence) {
  motion::ClipPair* pair = &sequence->pair;
  const int frames = pair->leader.frame_count();
  const int shortest = std::max(kMinCropFrames, frames / 2);
  if (frames <= shortest) return;
  const int kept = shortest + static_cast<int>(random->Below(frames - shortest + 1));
  const int first = static_cast<int>(random->Below(frames - kept + 1));
  std::vector<dataset::LabelSpan> labels = PartOf(sequence->labels, first, first + kept);
  // A sequence without spans would count as one of a single class.
  if (labels.empty() && !sequence->labels.empty()) return;
  for (motion::Clip* clip : {&pair->leader, &pair->follower}) {
    clip->poses = motion::Part(clip->poses, first, kept);
  }
  sequence->labels = std::move(labels);
}

// Plays both people `speed` times as fast, no longer than `longest` frames.
void Warp(double speed, int longest, dataset::Sequence* sequence) {
  motion::ClipPair* pair = &sequence->pair;
  const int frames = pair->leader.frame_count();
  const int warped = std::clamp(static_cast<int>(std::lround(frames / speed)), 2, longest);
  for (motion::Clip* clip : {&pair->leader, &pair->follower}) {
    motion::Poses after(warped, clip->joint_count());
    for (int t = 0; t < warped; ++t) {
      SampleLinear(clip->poses, t * (frames - 1.0) / (warped - 1.0), after[t]);
    }
    clip->poses = std::move(after);
  }
  for (dataset::LabelSpan& span : sequence->labels) {
    span.begin = span.begin * warped / frames;
    span.end = span.end * warped / frames;
  }
}

}  // namespace

motion::Vec3 Normal3(double deviation, base::Random* random) {
  return {static_cast<float>(random->Normal(deviation)),
          static_cast<float>(random->Normal(deviation)),
          static_cast<float>(random->Normal(deviation))};
}

std::vector<int> MirroredJoints(const motion::Skeleton& skeleton) {
  return retargeting::CounterpartJoints(skeleton.joint_names);
}

void Mirror(const std::vector<int>& mirrored_joints, motion::Poses* poses) {
  const motion::Poses before = *poses;
  for (int t = 0; t < before.frame_count(); ++t) {
    for (size_t j = 0; j < mirrored_joints.size(); ++j) {
      const motion::Vec3 point = before.at(t, mirrored_joints[j]);
      (*poses)[t][j] = {-point.x, point.y, point.z};
    }
  }
}

void Mirror(const std::vector<int>& mirrored_joints, dataset::Sequence* sequence) {
  Mirror(mirrored_joints, &sequence->pair.leader.poses);
  Mirror(mirrored_joints, &sequence->pair.follower.poses);
  if (sequence->partner_direction) sequence->partner_direction->x *= -1;
}

void SwapRoles(dataset::Sequence* sequence) {
  std::swap(sequence->pair.leader, sequence->pair.follower);
  if (sequence->partner_direction) sequence->partner_direction = -*sequence->partner_direction;
}

void DisturbLeader(const CommonSettings::Augmentation& options, base::Random* random,
                   motion::Clip* leader) {
  if (options.noise() > 0) AddNoise(options.noise(), random, leader);
  if (options.body_noise() > 0) AddBodyNoise(options.body_noise(), random, leader);
}

dataset::Sequence Augment(const dataset::Dataset& dataset, const dataset::Sequence& sequence,
                          const CommonSettings::Augmentation& options, base::Random* random) {
  dataset::Sequence variant = sequence;
  const size_t interaction = static_cast<size_t>(sequence.interaction_class);
  if (dataset.symmetric[interaction] && random->Chance(options.swap_roles())) SwapRoles(&variant);
  if (!dataset.handed[interaction] && options.mirror() > 0 && random->Chance(options.mirror())) {
    Mirror(MirroredJoints(dataset.skeleton), &variant);
  }
  motion::ClipPair* pair = &variant.pair;
  if (random->Chance(options.crop())) Crop(random, &variant);
  if (options.time_warp() > 0) {
    Warp(std::exp(random->Uniform(-options.time_warp(), options.time_warp())),
         dataset.LongestFrameCount(), &variant);
  }
  if (options.body_scale() > 0) {
    const double leader = 1 + random->Uniform(-options.body_scale(), options.body_scale());
    const double follower = 1 + random->Uniform(-options.body_scale(), options.body_scale());
    ScaleBodies(dataset.skeleton.root, leader, follower, pair);
  }
  if (options.yaw() > 0)
    Turn(random->Normal(options.yaw()), pair);  // partner_direction does not change
  if (options.leader_yaw() > 0) {
    TurnLeader(dataset.skeleton.root, random->Normal(options.leader_yaw()), &pair->leader);
  }
  DisturbLeader(options, random, &pair->leader);
  return variant;
}

}  // namespace duet::training

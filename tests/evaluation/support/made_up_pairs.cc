#include "tests/evaluation/support/made_up_pairs.h"

#include <cmath>

#include "tests/support/sample_motion.h"

namespace duet::test {
namespace {

constexpr int kLeastFrames = 16;
constexpr float kDistance = 1.2f;

// A figure in the standard coordinates: the root at the origin of the floor plan, facing -z.
std::vector<motion::Vec3> Figure(const motion::Skeleton& skeleton) {
  std::vector<motion::Vec3> pose = SwayingPose(0);
  const motion::Vec3 root = pose[static_cast<size_t>(skeleton.root)];
  const motion::Vec3 across = pose[static_cast<size_t>(skeleton.hips->right)] -
                              pose[static_cast<size_t>(skeleton.hips->left)];
  const double yaw = std::atan2(across.z, across.x);
  for (motion::Vec3& p : pose) p = RotateY(p - root, yaw) + motion::Vec3{0, root.y, 0};
  return pose;
}

struct Placement {
  double yaw;
  motion::Vec3 at;
};

void AddFrame(const Placement& placement, std::vector<motion::Vec3> pose, motion::Clip* clip) {
  for (motion::Vec3& p : pose) p = RotateY(p, placement.yaw) + placement.at;
  clip->Append(pose);
}

dataset::Sequence MakeSequence(const motion::Skeleton& skeleton, int interaction_class,
                               int number) {
  const size_t hand = static_cast<size_t>(skeleton.Find("right_hand"));
  const std::vector<motion::Vec3> figure = Figure(skeleton);
  // No two alike, evenly spread (the golden ratio's multiples).
  const float reach = 0.2f + 0.5f * static_cast<float>(std::fmod(0.618034 * number, 1.0));
  const int frames = kLeastFrames + number % 4;
  const Placement placement = {0.9 * number, {0.3f * static_cast<float>(number), 0, -1}};
  dataset::Sequence sequence;
  sequence.id = std::to_string(interaction_class) + "/" + std::to_string(number);
  sequence.interaction_class = interaction_class;
  sequence.subjects = {std::string(1, static_cast<char>('a' + number % 3))};
  motion::Clip& leader = sequence.pair.leader;
  leader.joint_names = skeleton.joint_names;
  leader.frame_rate_hz = 15;
  sequence.pair.follower = leader;
  for (int t = 0; t < frames; ++t) {
    const float raised =
        reach * static_cast<float>(std::sin(M_PI * t / static_cast<double>(frames - 1)));
    std::vector<motion::Vec3> pose = figure;
    pose[hand].y += raised;
    AddFrame(placement, pose, &leader);
    const bool give = interaction_class == 0;
    std::vector<motion::Vec3> answer = figure;
    answer[hand].y += give ? raised : -raised;
    for (motion::Vec3& p : answer) {
      p = RotateY(p, M_PI) + motion::Vec3{0, 0, -kDistance - (give ? 0.5f : 2.0f) * raised};
    }
    AddFrame(placement, answer, &sequence.pair.follower);
  }
  return sequence;
}

}  // namespace

dataset::Dataset MadeUpPairs(int sequences_a_class) {
  dataset::Dataset dataset;
  dataset.name = "made up";
  dataset.skeleton = motion::SbuSkeleton();
  dataset.parts = motion::SbuParts();
  dataset.classes = {"give", "flinch"};
  dataset.symmetric = {false, false};
  dataset.handed = {false, false};
  dataset.touches = {false, false};
  dataset.frame_rate_hz = 15;
  for (int c = 0; c < dataset.class_count(); ++c) {
    for (int i = 0; i < sequences_a_class; ++i) {
      dataset.sequences.push_back(MakeSequence(dataset.skeleton, c, i));
    }
  }
  return dataset;
}

}  // namespace duet::test

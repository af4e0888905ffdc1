#ifndef DUET_TESTS_TRAINING_MADE_UP_DATASET_H_
#define DUET_TESTS_TRAINING_MADE_UP_DATASET_H_

#include <algorithm>
#include <string>

#include "model/dataset/dataset.h"
#include "tests/support/sample_motion.h"

namespace duet::training {

using test::SwayingMotion;
using test::SwayingPose;

// Sequences of two synthetic people in three classes. The second class is symmetric, with touching
// bodies; all except the first are handed. The follower stands 1 m along +z of the leader and sways
// later and, depending on the class, higher.
inline dataset::Dataset MadeUpDataset(int sequences = 7) {
  dataset::Dataset dataset;
  dataset.name = "made_up";
  dataset.skeleton = motion::SbuSkeleton();
  dataset.parts = motion::SbuParts();
  dataset.classes = {"kick", "hug", "punch"};
  dataset.symmetric = {false, true, false};
  dataset.handed = {false, true, true};
  dataset.touches = {false, true, false};
  dataset.frame_rate_hz = 15;
  for (int i = 0; i < sequences; ++i) {
    dataset::Sequence sequence;
    sequence.id = "sequence" + std::to_string(i);
    sequence.interaction_class = i % 3;
    sequence.subjects = {i % 2 == 0 ? "s01" : "s02"};
    const int frames = 12 + i;
    motion::Clip& leader = sequence.pair.leader;
    leader.joint_names = dataset.skeleton.joint_names;
    leader.frame_rate_hz = dataset.frame_rate_hz;
    sequence.pair.follower = leader;
    leader.poses = SwayingMotion(frames, dataset.frame_rate_hz);
    for (int t = 0; t < frames; ++t) {
      std::vector<motion::Vec3> pose = SwayingPose((t + i) / dataset.frame_rate_hz);
      for (motion::Vec3& point : pose) {
        point += motion::Vec3{0, 0.1f * static_cast<float>(sequence.interaction_class), 1};
      }
      sequence.pair.follower.Append(pose);
    }
    sequence.partner_direction = motion::Vec3{0, 0, 1};
    dataset.sequences.push_back(sequence);
  }
  return dataset;
}

inline std::vector<int> AllOf(const dataset::Dataset& dataset) {
  std::vector<int> all(dataset.sequences.size());
  for (size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  return all;
}

}  // namespace duet::training

#endif  // DUET_TESTS_TRAINING_MADE_UP_DATASET_H_

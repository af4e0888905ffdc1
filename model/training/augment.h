#ifndef DUET_MODEL_TRAINING_AUGMENT_H_
#define DUET_MODEL_TRAINING_AUGMENT_H_

#include <random>
#include <vector>

#include "model/dataset/dataset.h"
#include "model/training/options.h"

namespace duet::training {

// Random numbers of one epoch: seeded by run and epoch alone, so that a resumed run draws what an
// uninterrupted one would. The distributions are our own: the standard library's differ.
class EpochRandom {
 public:
  EpochRandom(uint64_t seed, int64_t epoch);

  double Uniform(double low, double high);
  double Normal(double deviation);
  bool Chance(double probability) { return Uniform(0, 1) < probability; }
  int64_t Below(int64_t end);

 private:
  std::mt19937_64 bits_;
};

// The joint that takes each joint's place in a mirror: left and right exchanged by name.
std::vector<int> MirroredJoints(const motion::Skeleton& skeleton);

// Reflects both people in the plane x = 0 and exchanges their left and right joints.
void Mirror(const std::vector<int>& mirrored_joints, dataset::Sequence* sequence);

// Exchanges leader and follower.
void SwapRoles(dataset::Sequence* sequence);

// A random variant of a sequence. Requires options that CheckAgainst accepts.
dataset::Sequence Augment(const dataset::Dataset& dataset, const dataset::Sequence& sequence,
                          const TrainingOptions::Augmentation& options, EpochRandom* random);

}  // namespace duet::training

#endif  // DUET_MODEL_TRAINING_AUGMENT_H_

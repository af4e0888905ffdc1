#ifndef DUET_MODEL_TRAINING_AUGMENT_H_
#define DUET_MODEL_TRAINING_AUGMENT_H_

#include <random>
#include <vector>

#include "model/dataset/dataset.h"
#include "model/training/options.h"

namespace duet {

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
std::vector<int> MirroredJoints(const Skeleton& skeleton);

// Reflects both people in the plane x = 0 and exchanges their left and right joints.
void Mirror(const std::vector<int>& mirrored_joints, Sequence* sequence);

// Exchanges leader and follower.
void SwapRoles(Sequence* sequence);

// A random variant of a sequence. Requires options that CheckAgainst accepts.
Sequence Augment(const Dataset& dataset, const Sequence& sequence,
                 const TrainingOptions::Augmentation& options, EpochRandom* random);

}  // namespace duet

#endif  // DUET_MODEL_TRAINING_AUGMENT_H_

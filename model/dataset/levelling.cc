#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "model/dataset/dataset.h"
#include "model/motion/posture.h"

namespace duet::dataset {
namespace {

// Weight of the whole data set's vertical, in sequences: sets differ by what their people do about
// as much as by their camera.
constexpr float kSharedSequences = 3;
constexpr std::size_t kFewestPoses = 60;
constexpr float kLeastUpright = 0.866f;  // the cosine of 30 degrees
constexpr double kFloorShare = 0.25;     // fraction of the lower feet that are below the floor

struct SetOfSequences {
  std::vector<Sequence*> sequences;
  std::vector<motion::Vec3> directions;
};

void Append(const std::vector<motion::Vec3>& more, std::vector<motion::Vec3>* all) {
  all->insert(all->end(), more.begin(), more.end());
}

std::map<std::string, SetOfSequences> GatherSets(Dataset* dataset) {
  std::map<std::string, SetOfSequences> sets;
  for (Sequence& sequence : dataset->sequences) {
    SetOfSequences& set = sets[sequence.set];
    set.sequences.push_back(&sequence);
    Append(StandingDirections(dataset->skeleton, sequence.pair.leader.poses), &set.directions);
    Append(StandingDirections(dataset->skeleton, sequence.pair.follower.poses), &set.directions);
  }
  return sets;
}

// Rotates the set, then finds its floor.
void Level(const motion::Skeleton& skeleton, motion::Vec3 up, SetOfSequences* set) {
  const motion::Levelling turn(up, 0);
  std::vector<motion::Vec3> feet;
  for (const Sequence* sequence : set->sequences) {
    Append(LowerFeet(skeleton, turn.Apply(sequence->pair.leader.poses)), &feet);
    Append(LowerFeet(skeleton, turn.Apply(sequence->pair.follower.poses)), &feet);
  }
  const motion::Levelling levelling(up, HeightQuantile(feet, kFloorShare));
  for (Sequence* sequence : set->sequences) {
    sequence->levelling = levelling;
    for (motion::Clip* clip : {&sequence->pair.leader, &sequence->pair.follower}) {
      clip->poses = levelling.Apply(std::move(clip->poses));
    }
  }
}

}  // namespace

void LevelSets(Dataset* dataset) {
  std::map<std::string, SetOfSequences> sets = GatherSets(dataset);
  std::vector<motion::Vec3> all;
  for (const auto& [name, set] : sets) Append(set.directions, &all);
  if (all.size() < kFewestPoses) return;
  const motion::Vec3 shared = RobustMean(all);
  for (auto& [name, set] : sets) {
    const auto own_sequences = static_cast<float>(set.sequences.size());
    const motion::Vec3 sum = own_sequences * RobustMean(set.directions) + kSharedSequences * shared;
    const motion::Vec3 up = sum / Norm(sum);
    if (up.y >= kLeastUpright) Level(dataset->skeleton, up, &set);
  }
}

}  // namespace duet::dataset

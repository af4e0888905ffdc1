#include "model/training/exchanged_leaders.h"

#include <cstddef>
#include <set>
#include <utility>

#include "model/motion/filter.h"
#include "model/motion/standardise.h"

namespace duet::training {
namespace {

constexpr int kTries = 5;
constexpr double kMostEqualLabels = 0.3;
constexpr double kPathSmoothing = 10;  // frames; removes the sway of each step from a path

std::set<int> ClassesAt(const dataset::Sequence& sequence, int frame) {
  if (sequence.labels.empty()) return {sequence.interaction_class};
  std::set<int> classes;
  for (const dataset::LabelSpan& span : sequence.labels) {
    if (span.begin <= frame && frame < span.end) classes.insert(span.interaction_class);
  }
  return classes;
}

motion::Standardisation FrameOf(const motion::Skeleton& skeleton, const motion::Poses& leader) {
  return {skeleton, leader, motion::YawDirection::kRemove, motion::StandardOrigin::kFirstFrame};
}

}  // namespace

double EqualLabels(const dataset::Sequence& a, const dataset::Sequence& b) {
  const int frames = a.pair.leader.frame_count();
  int equal = 0;
  for (int t = 0; t < frames; ++t) equal += ClassesAt(a, t) == ClassesAt(b, t) ? 1 : 0;
  return equal / static_cast<double>(frames);
}

dataset::Sequence WithLeaderOf(const motion::Skeleton& skeleton, const dataset::Sequence& other,
                               dataset::Sequence sequence) {
  const int frames = sequence.pair.leader.frame_count();
  motion::Poses leader = other.pair.leader.poses;
  leader.Resize(frames);
  const motion::Standardisation own = FrameOf(skeleton, sequence.pair.leader.poses),
                                new_frame = FrameOf(skeleton, leader);
  const auto path = [](const motion::Standardisation& frame, const motion::Poses& poses) {
    return motion::GaussianFilter(frame.Apply(poses), kPathSmoothing);
  };
  const motion::Poses from = path(own, sequence.pair.leader.poses), to = path(new_frame, leader);
  motion::Poses follower = own.Apply(sequence.pair.follower.poses);
  for (int t = 0; t < frames; ++t) {
    motion::Vec3 by = to.at(t, skeleton.root) - from.at(t, skeleton.root);
    by.y = 0;
    for (motion::Vec3& joint : follower[t]) joint += by;
  }
  sequence.pair.follower.poses = new_frame.Invert(follower);
  sequence.pair.leader.poses = std::move(leader);
  return sequence;
}

void ExchangeLeaders(const motion::Skeleton& skeleton, double share, base::Random* random,
                     std::vector<dataset::Sequence>* sequences) {
  if (share == 0) return;
  std::vector<std::pair<std::size_t, dataset::Sequence>> exchanged;
  for (std::size_t i = 0; i < sequences->size(); ++i) {
    if (!random->Chance(share)) continue;
    const dataset::Sequence& sequence = (*sequences)[i];
    for (int n = 0; n < kTries; ++n) {
      const dataset::Sequence& other = (*sequences)[static_cast<std::size_t>(
          random->Below(static_cast<int>(sequences->size())))];
      if (other.pair.leader.frame_count() < sequence.pair.leader.frame_count() ||
          EqualLabels(sequence, other) > kMostEqualLabels) {
        continue;
      }
      exchanged.emplace_back(i, WithLeaderOf(skeleton, other, sequence));
      break;
    }
  }
  for (auto& [index, sequence] : exchanged) (*sequences)[index] = std::move(sequence);
}

}  // namespace duet::training

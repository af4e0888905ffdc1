#include <algorithm>

#include "model/engine/windows.h"
#include "model/motion/resample.h"
#include "model/training/sampler.h"

namespace duet::training {
namespace {

constexpr double kGraded = 0.30, kNegative = 0.15, kOtherAvoided = 0.10;  // the rest is mixed
constexpr double kMixWithoutOwn = 0.3;  // of the mixed: only the other class
constexpr double kLargestOwn = 1.5, kLargestOther = 1.2;

// Rejection sampling with a limit on tries is enough, because no class is rare.
constexpr int kTries = 64;

const dataset::Sequence* DrawOther(const std::vector<dataset::Sequence>& pool,
                                   int interaction_class, base::Random* random) {
  for (int i = 0; i < kTries; ++i) {
    const dataset::Sequence& drawn =
        pool[static_cast<size_t>(random->Below(static_cast<int64_t>(pool.size())))];
    if (drawn.interaction_class != interaction_class) return &drawn;
  }
  return nullptr;
}

// The place of a sequence: the leader's first root and the yaw of its frame.
struct Place {
  motion::Vec3 origin;
  double yaw;
};

Place PlaceOf(const dataset::Dataset& dataset, const dataset::Sequence& sequence) {
  engine::SynthesisWindow window;
  window.leader = sequence.pair.leader.poses;
  window.partner_direction = sequence.partner_direction;
  return {sequence.pair.leader.at(0, dataset.skeleton.root),
          WindowStandardisation(dataset.skeleton, window).yaw()};
}

// The first pose in all frames.
motion::Poses Still(const motion::Poses& follower) {
  motion::Poses still(0, follower.joint_count());
  for (int t = 0; t < follower.frame_count(); ++t) still.Append(follower[0]);
  return still;
}

// The follower of `other`, resampled to the length and moved to the place of `sequence`.
motion::Poses Borrow(const dataset::Dataset& dataset, const dataset::Sequence& other,
                     const dataset::Sequence& sequence, bool begin_at_pose) {
  const int joints = dataset.skeleton.joint_count();
  const motion::Poses& source = other.pair.follower.poses;
  const motion::Poses& own = sequence.pair.follower.poses;
  const int frames = own.frame_count();
  const double step = frames > 1 ? (source.frame_count() - 1.0) / (frames - 1.0) : 0;
  motion::Poses borrowed(frames, joints);
  for (int t = 0; t < frames; ++t) SampleLinear(source, t * step, borrowed[t]);
  const Place from = PlaceOf(dataset, other), to = PlaceOf(dataset, sequence);
  for (motion::Vec3& point : borrowed.all()) {
    point = to.origin + RotateY(point - from.origin, from.yaw - to.yaw);
  }
  if (!begin_at_pose) return borrowed;
  for (int j = 0; j < joints; ++j) {
    const motion::Vec3 offset = own.at(0, j) - borrowed.at(0, j);
    for (int t = 0; t < frames; ++t) borrowed.at(t, j) += offset;
  }
  return borrowed;
}

// still + own_share (captured - still) + other_share (other - still)
motion::Poses Combine(const motion::Poses& still, const motion::Poses& captured, double own_share,
                      const motion::Poses& other, double other_share) {
  motion::Poses combined = still;
  for (size_t i = 0; i < still.all().size(); ++i) {
    const motion::Vec3 at = still.all()[i];
    combined.all()[i] = at + (captured.all()[i] - at) * static_cast<float>(own_share) +
                        (other.all()[i] - at) * static_cast<float>(other_share);
  }
  return combined;
}

}  // namespace

Example CapturedExample(const dataset::Dataset& dataset, dataset::Sequence sequence,
                        StartKnowledge start) {
  Example example;
  example.start = start;
  example.weights.assign(dataset.classes.size(), 0);
  example.weights[static_cast<size_t>(sequence.interaction_class)] = 1;
  example.target = sequence.pair.follower.poses;
  example.sequence = std::move(sequence);
  return example;
}

void GradeLabels(const dataset::Dataset& dataset, const std::vector<dataset::Sequence>& pool,
                 base::Random* random, Example* example) {
  const dataset::Sequence& sequence = example->sequence;
  const dataset::Sequence* drawn = DrawOther(pool, sequence.interaction_class, random);
  if (drawn == nullptr) return;
  example->single = false;
  float& own = example->weights[static_cast<size_t>(sequence.interaction_class)];
  float& another = example->weights[static_cast<size_t>(drawn->interaction_class)];
  const motion::Poses& captured = sequence.pair.follower.poses;
  const motion::Poses still = Still(captured);
  const motion::Poses other =
      Borrow(dataset, *drawn, sequence, example->start == StartKnowledge::kPose);

  const double kind = random->Uniform(0, 1);
  double own_share = 1, other_share = 0;
  if (kind < kGraded) {
    own_share = random->Uniform(0, kLargestOwn);
    own = static_cast<float>(own_share);
  } else if (kind < kGraded + kNegative) {
    own_share = 0;
    other_share = random->Uniform(0, 1);
    own = static_cast<float>(-other_share);
  } else if (kind < kGraded + kNegative + kOtherAvoided) {
    another = static_cast<float>(-random->Uniform(0, 1));
  } else {
    const double p = random->Chance(kMixWithoutOwn) ? 0 : random->Uniform(0, 1);
    const double q = random->Uniform(0, kLargestOther);
    const double total = std::max(p + q, 1.0);
    own = static_cast<float>(p);
    another = static_cast<float>(q);
    own_share = p / total;
    other_share = q / total;
  }
  example->target = Combine(still, captured, own_share, other, other_share);
}

}  // namespace duet::training

#include "model/training/other_lead.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "model/base/angle.h"
#include "model/motion/standardise.h"

namespace duet::training {
namespace {

using motion::Vec3;

constexpr int kDraws = 8;

// Where a person stands and faces in a frame.
struct Place {
  Vec3 on_floor;
  double yaw;  // radians about +y that turn the person to the standard direction
};

Place PlaceOf(const motion::Skeleton& skeleton, const motion::Poses& person, int frame) {
  const Vec3 root = person.at(frame, skeleton.root);
  const motion::Poses pose(person.joint_count(), {person[frame].begin(), person[frame].end()});
  return {{root.x, 0, root.z}, motion::Standardisation(skeleton, pose).yaw()};
}

bool SharesClass(const dataset::Sequence& a, const dataset::Sequence& b, int from, int end) {
  const auto holds = [&](const dataset::LabelSpan& span) {
    return span.begin < end && span.end > from;
  };
  return std::any_of(a.labels.begin(), a.labels.end(), [&](const dataset::LabelSpan& one) {
    return holds(one) && std::any_of(b.labels.begin(), b.labels.end(), [&](const auto& other) {
             return holds(other) && other.interaction_class == one.interaction_class;
           });
  });
}

}  // namespace

motion::Poses ContinuedBy(const motion::Skeleton& skeleton, const motion::Poses& own, int last,
                          const motion::Poses& other, int join_frames) {
  const Place to = PlaceOf(skeleton, own, last), from = PlaceOf(skeleton, other, last);
  const auto moved = [&](int t, int joint) {
    return RotateY(other.at(t, joint) - from.on_floor, from.yaw - to.yaw) + to.on_floor;
  };
  motion::Poses continued = own;
  for (int t = last + 1; t < own.frame_count(); ++t) {
    const double since = std::min(1.0, static_cast<double>(t - last) / (join_frames + 1));
    const auto share = static_cast<float>(0.5 + 0.5 * std::cos(base::kPi * since));
    for (int j = 0; j < own.joint_count(); ++j) {
      continued.at(t, j) = moved(t, j) + (own.at(last, j) - moved(last, j)) * share;
    }
  }
  return continued;
}

const dataset::Sequence* DrawOther(const std::vector<dataset::Sequence>& sequences,
                                   const dataset::Sequence& own, int last, base::Random* random) {
  if (own.labels.empty()) return nullptr;
  const int frames = own.pair.leader.frame_count();
  for (int draw = 0; draw < kDraws; ++draw) {
    const auto index = random->Below(static_cast<int64_t>(sequences.size()));
    const dataset::Sequence& other = sequences[static_cast<std::size_t>(index)];
    if (other.labels.empty() || other.pair.leader.frame_count() < frames) continue;
    if (!SharesClass(own, other, last + 1, frames)) return &other;
  }
  return nullptr;
}

}  // namespace duet::training

#include "model/cleanup/strikes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "model/body/hands.h"
#include "model/cleanup/directions.h"
#include "model/cleanup/offset_track.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;

// The way is found in so many steps: the nearest point of the surface changes on it.
constexpr int kRounds = 6;

// The way along the floor that brings a body to `metres` from a point, at most `farthest`.
Vec3 WayTo(Vec3 point, double metres, double farthest, int root, const body::Surface& surface,
           absl::Span<const Vec3> pose) {
  const Vec3 from = pose[static_cast<std::size_t>(root)];
  const Vec3 across = {point.x - from.x, 0, point.z - from.z};
  if (Norm(across) < kNoOffset) return {};
  const Vec3 direction = across / Norm(across);
  double way = 0;
  for (int round = 0; round < kRounds; ++round) {
    const double missing = surface.Distance(point - direction * static_cast<float>(way), pose);
    if (missing <= metres) break;
    way += missing - metres;
  }
  return direction * static_cast<float>(std::min({way, farthest, double{Norm(across)}}));
}

// Adds the strikes of one limb: in each stretch of frames in which it reaches out, the frame in
// which it is nearest to the body.
class LimbStrikes {
 public:
  LimbStrikes(const motion::Skeleton& skeleton, const body::Surface& surface,
              const motion::Poses& leader, const motion::Poses& follower)
      : root_(skeleton.root), surface_(surface), leader_(leader), follower_(follower) {}

  // `weight`, `metres`: of the limb. `least_reach`: from which reach on it strikes.
  void Add(const body::Limb& limb, float Meeting::*weight, float Meeting::*metres,
           double least_reach, const Meetings& meetings, const StrikeOptions& options, int first,
           std::vector<Offset>* offsets) const {
    double nearest = HUGE_VAL;
    int frame = -1;
    const auto end = [&] {
      if (frame >= first) {
        const Meeting& meeting = meetings[static_cast<std::size_t>(frame)];
        const Vec3 way = WayTo(leader_.at(frame, limb.end), double{meeting.*metres},
                               options.farthest_metres, root_, surface_, follower_[frame]);
        if (Norm(way) > 0) offsets->push_back({double(frame), way * (meeting.*weight)});
      }
      nearest = HUGE_VAL;
      frame = -1;
    };
    for (int t = 0; t < follower_.frame_count(); ++t) {
      if (meetings[static_cast<std::size_t>(t)].*weight == 0 ||
          body::ReachTowards(limb, root_, leader_[t], follower_.at(t, root_)) < least_reach) {
        end();
        continue;
      }
      const double distance = surface_.Distance(leader_.at(t, limb.end), follower_[t]);
      if (distance < nearest) {
        nearest = distance;
        frame = t;
      }
    }
    end();
  }

 private:
  const int root_;
  const body::Surface& surface_;
  const motion::Poses& leader_;
  const motion::Poses& follower_;
};

}  // namespace

void ApproachStrikes(const motion::Skeleton& skeleton, const body::Body& body,
                     const body::Surface& surface, const motion::Poses& leader,
                     const Meetings& meetings, const StrikeOptions& options, const Timing& timing,
                     motion::Poses* follower) {
  const LimbStrikes strikes(skeleton, surface, leader, *follower);
  std::vector<Offset> offsets;
  for (const body::Limb& arm : body.arms) {
    strikes.Add(arm, &Meeting::fist, &Meeting::strike_metres, body::kOffersReach, meetings, options,
                timing.settled, &offsets);
  }
  for (const body::Limb& leg : body.legs) {
    strikes.Add(leg, &Meeting::foot, &Meeting::foot_metres, body::kKicksReach, meetings, options,
                timing.settled, &offsets);
  }
  if (offsets.empty()) return;
  std::stable_sort(offsets.begin(), offsets.end(),
                   [](const Offset& a, const Offset& b) { return a.frame < b.frame; });
  const OffsetLimits limits{options.ease_seconds, options.gentle_metres_per_second,
                            options.fastest_metres_per_second};
  const std::vector<Vec3> ways =
      OffsetTrack(std::move(offsets), limits, timing, follower->frame_count());
  for (int t = timing.settled; t < follower->frame_count(); ++t) {
    for (Vec3& joint : (*follower)[t]) joint += ways[static_cast<std::size_t>(t)];
  }
}

}  // namespace duet::cleanup

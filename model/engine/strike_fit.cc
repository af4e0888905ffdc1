#include "model/engine/strike_fit.h"

#include <algorithm>
#include <cstddef>

#include "model/base/median.h"
#include "model/body/hands.h"

namespace duet::engine {
namespace {

// The least share of the stretches in which a limb that strikes reaches out.
constexpr double kLeastShare = 0.75;
// The median distance from the body at which it ends, at most, metres. People who only act a kick
// stop short of their partner.
constexpr double kNear = 0.4;

}  // namespace

StrikeFit::StrikeFit(const motion::Skeleton& skeleton)
    : skeleton_(skeleton),
      body_(body::FindBody(skeleton)),
      surface_(skeleton, body_),
      kinds_{{StrikingLimb::kFist, &body::Body::arms, body::kOffersReach, {}},
             {StrikingLimb::kFoot, &body::Body::legs, body::kKicksReach, {}}} {}

void StrikeFit::Add(const motion::Poses& leader, const motion::Poses& follower, int begin,
                    int end) {
  ++stretches_;
  for (Kind& kind : kinds_) {
    std::optional<double> nearest;
    for (int t = begin; t < end; ++t) {
      for (const body::Limb& limb : body_.*kind.limbs) {
        const motion::Vec3 partner = follower.at(t, skeleton_.root);
        if (body::ReachTowards(limb, skeleton_.root, leader[t], partner) < kind.least_reach) {
          continue;
        }
        const double distance = surface_.Distance(leader.at(t, limb.end), follower[t]);
        nearest = std::min(nearest.value_or(distance), distance);
      }
    }
    if (nearest) kind.nearest.push_back(*nearest);
  }
}

std::optional<StrikingLimb> StrikeFit::Limb() const {
  std::optional<StrikingLimb> limb;
  double nearest = kNear;
  for (const Kind& kind : kinds_) {
    if (static_cast<double>(kind.nearest.size()) < kLeastShare * std::max(1, stretches_)) continue;
    const double median = base::Median(kind.nearest);
    if (median > nearest) continue;
    nearest = median;
    limb = kind.limb;
  }
  return limb;
}

}  // namespace duet::engine

#include "model/engine/hand_contact_fit.h"

#include <algorithm>
#include <cstddef>

#include "model/base/statistics.h"
#include "model/body/contact.h"

namespace duet::engine {
namespace {

// Hands at this distance meet, metres.
constexpr double kMeets = 0.25;
// The least share of an offered hand's time that is met. The solver meets every offered hand of the
// class, so that a smaller share would close more hands than it should. People who
// exchange an object in solved captures of SBU have .37, and their hands do meet.
constexpr double kLeastShare = 0.3;
constexpr double kLeastSeconds = 3;
// Of the distances of hands that meet, the larger ones belong to hands that come and go: the
// distance at which they hold each other is the lower quartile.
constexpr double kHolds = 0.25;

}  // namespace

HandContactFit::HandContactFit(const motion::Skeleton& skeleton)
    : skeleton_(skeleton), body_(body::FindBody(skeleton)) {}

void HandContactFit::Add(const motion::Poses& leader, const motion::Poses& follower, int begin,
                         int end) {
  if (!body_.shoulders) return;
  int offered = 0;
  const std::size_t met_before = met_.size();
  for (int t = begin; t < end; ++t) {
    for (const body::Limb& arm : body_.arms) {
      if (body::ReachTowards(arm, skeleton_.root, leader[t], follower.at(t, skeleton_.root)) <
          body::kOffersReach) {
        continue;
      }
      ++offered;
      const motion::Vec3 hand = leader.at(t, arm.end);
      const float distance = std::min(Distance(hand, follower.at(t, body_.arms[0].end)),
                                      Distance(hand, follower.at(t, body_.arms[1].end)));
      if (distance < kMeets) met_.push_back(double{distance});
    }
  }
  if (offered == 0) return;
  offered_ += offered;
  shares_.push_back(static_cast<double>(met_.size() - met_before) / offered);
}

std::optional<double> HandContactFit::Metres(double frame_rate_hz) const {
  if (offered_ < kLeastSeconds * frame_rate_hz) return std::nullopt;
  if (base::Mean(shares_) < kLeastShare) return std::nullopt;
  return base::Quantile(met_, kHolds);
}

}  // namespace duet::engine

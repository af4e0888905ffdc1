#include "model/engine/hand_contact_fit.h"

#include <algorithm>
#include <cstddef>

#include "model/base/median.h"
#include "model/body/hands.h"

namespace duet::engine {
namespace {

// Hands at this distance meet, metres.
constexpr double kMeets = 0.25;
// The least share of offered hands that are met.
constexpr double kLeastShare = 0.25;
constexpr double kLeastSeconds = 3;

}  // namespace

HandContactFit::HandContactFit(const motion::Skeleton& skeleton)
    : skeleton_(skeleton), body_(body::FindBody(skeleton)) {}

void HandContactFit::Add(const motion::Poses& leader, const motion::Poses& follower, int begin,
                         int end) {
  if (!body_.shoulders) return;
  for (int t = begin; t < end; ++t) {
    for (const body::Limb& offered : body_.arms) {
      if (body::ReachTowards(offered, skeleton_.root, leader[t], follower.at(t, skeleton_.root)) <
          body::kOffersReach) {
        continue;
      }
      const motion::Vec3 hand = leader.at(t, offered.end);
      distances_.push_back(double{std::min(Distance(hand, follower.at(t, body_.arms[0].end)),
                                           Distance(hand, follower.at(t, body_.arms[1].end)))});
    }
  }
}

std::optional<double> HandContactFit::Metres(double frame_rate_hz) const {
  std::vector<double> met;
  for (const double distance : distances_) {
    if (distance < kMeets) met.push_back(distance);
  }
  const double offered = static_cast<double>(distances_.size());
  if (offered < kLeastSeconds * frame_rate_hz) return std::nullopt;
  if (static_cast<double>(met.size()) < kLeastShare * offered) return std::nullopt;
  return base::Median(std::move(met));
}

}  // namespace duet::engine

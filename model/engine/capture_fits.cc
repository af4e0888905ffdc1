#include "model/engine/capture_fits.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "model/base/median.h"
#include "model/base/statistics.h"
#include "model/body/contact.h"
#include "model/motion/limb_lengths.h"
#include "model/motion/resample.h"
#include "model/solver/partner.h"

namespace duet::engine {
namespace {

using motion::Vec3;

constexpr double kLeastSeconds = 3;  // shorter times show nothing
// Hands at this distance meet, metres.
constexpr double kMeets = 0.25;
// The least share of an offered hand's time that is met. The solver meets every offered hand of the
// class, so that a smaller share would close more hands than it should. People who exchange an
// object in solved captures of SBU have .37, and their hands do meet.
constexpr double kLeastMet = 0.3;
// Of the distances of hands that meet, the larger ones belong to hands that come and go: the
// distance at which they hold each other is the lower quartile.
constexpr double kHolds = 0.25;
// The distance of the roots of close people, and the distances from the axis of a trunk at which a
// hand is at the trunk: in a body it is an error of the capture. Metres.
constexpr float kClose = 0.5f, kInBody = 0.11f, kAtTrunk = 0.25f;
// The least share of the time of close people in which a hand is at the trunk.
constexpr double kLeastHeld = 0.2;
// The share of the time in which followers are not turned away farther.
constexpr double kFacingShare = 0.9;
// Followers who are turned away farther than that go beside their leaders, or dance.
constexpr double kFarthestDegrees = 75;
constexpr double kClearlyOther = 0.02;  // of the size

// The median place of a hand around a trunk's axis: at its mean direction, so that hands on all
// sides of a trunk have no place within it. Shapes: places (solver::TrunkAxes).
Vec3 MedianPlace(const std::vector<Vec3>& places) {
  std::vector<float> heights, radii;
  Vec3 direction;
  for (const Vec3 place : places) {
    heights.push_back(place.y);
    radii.push_back(std::hypot(place.x, place.z));
    direction += Vec3{place.x, 0, place.z} / radii.back();
  }
  const float length = Norm(direction);
  Vec3 median = length > 0 ? direction * (base::Median(radii) / length) : Vec3{};
  median.y = base::Median(heights);
  return median;
}

}  // namespace

std::optional<double> HandContactMetres(const motion::Skeleton& skeleton,
                                        const Stretches& stretches, double frame_rate_hz) {
  const body::Body body = body::FindBody(skeleton);
  if (!body.shoulders) return std::nullopt;
  int all_offered = 0;         // frames in which a hand is offered
  std::vector<double> met;     // distances of offered hands that the follower's hand meets
  std::vector<double> shares;  // of the offered frames that are met, in each stretch
  for (const Stretch& stretch : stretches) {
    int offered = 0;
    const std::size_t met_before = met.size();
    for (int t = stretch.begin; t < stretch.end; ++t) {
      const motion::Poses &leader = *stretch.leader, &follower = *stretch.follower;
      for (const body::Limb& arm : body.arms) {
        if (body::ReachTowards(arm, skeleton.root, leader[t], follower.at(t, skeleton.root)) <
            body::kOffersReach) {
          continue;
        }
        ++offered;
        const Vec3 hand = leader.at(t, arm.end);
        const float distance = std::min(Distance(hand, follower.at(t, body.arms[0].end)),
                                        Distance(hand, follower.at(t, body.arms[1].end)));
        if (distance < kMeets) met.push_back(double{distance});
      }
    }
    if (offered == 0) continue;
    all_offered += offered;
    shares.push_back(static_cast<double>(met.size() - met_before) / offered);
  }
  if (all_offered < kLeastSeconds * frame_rate_hz) return std::nullopt;
  if (base::Mean(shares) < kLeastMet) return std::nullopt;
  return base::Quantile(met, kHolds);
}

std::vector<TrunkContact> TrunkContacts(const motion::Skeleton& skeleton,
                                        const Stretches& stretches, double frame_rate_hz) {
  const body::Body body = body::FindBody(skeleton);
  std::vector<TrunkContact> contacts;
  if (!skeleton.hips || !body.shoulders) return contacts;
  for (const body::Limb& arm : body.arms) {
    int close = 0;
    std::vector<Vec3> places;
    for (const Stretch& stretch : stretches) {
      for (int t = stretch.begin; t < stretch.end; ++t) {
        const Vec3 between =
            stretch.leader->at(t, skeleton.root) - stretch.follower->at(t, skeleton.root);
        if (std::hypot(between.x, between.z) > kClose) continue;
        ++close;
        const solver::TrunkAxes trunk = solver::TrunkAxesOf(skeleton, body, (*stretch.leader)[t]);
        const Vec3 place = trunk.PlaceOf(stretch.follower->at(t, arm.end));
        const float beyond = place.y - std::clamp(place.y, 0.0f, 1.0f);
        const float around = std::hypot(place.x, place.z) * trunk.length;
        if (around < kInBody || std::hypot(around, beyond * trunk.length) > kAtTrunk) continue;
        places.push_back(place);
      }
    }
    if (static_cast<double>(places.size()) < kLeastHeld * close ||
        close < kLeastSeconds * frame_rate_hz) {
      continue;
    }
    contacts.push_back(
        {"", skeleton.joint_names[static_cast<std::size_t>(arm.end)], MedianPlace(places)});
  }
  return contacts;
}

std::optional<double> FacingDegrees(const motion::Skeleton& skeleton, const Stretches& stretches,
                                    double frame_rate_hz) {
  const body::Body body = body::FindBody(skeleton);
  if (!skeleton.hips || !body.shoulders) return std::nullopt;
  std::vector<double> away;  // of every frame
  for (const Stretch& stretch : stretches) {
    const int frames = stretch.end - stretch.begin;
    for (const double degrees : solver::DegreesAway(
             skeleton, body, motion::Part(*stretch.leader, stretch.begin, frames),
             motion::Part(*stretch.follower, stretch.begin, frames), frame_rate_hz)) {
      // A follower who turns on is turned away by any angle.
      away.push_back(std::abs(std::remainder(degrees, 360)));
    }
  }
  if (static_cast<double>(away.size()) < kLeastSeconds * frame_rate_hz) return std::nullopt;
  const double degrees = base::Quantile(away, kFacingShare);
  return degrees > kFarthestDegrees ? std::nullopt : std::optional<double>(degrees);
}

std::vector<double> BoneRatios(const motion::Skeleton& skeleton, const Stretches& pairs) {
  std::vector<std::vector<double>> ratios(skeleton.bones.size());  // of every bone, [pairs]
  std::vector<double> sizes;  // of every pair: the follower's bones, together
  for (const Stretch& pair : pairs) {
    const std::vector<float> leaders = MedianBoneLengths(skeleton, *pair.leader),
                             followers = MedianBoneLengths(skeleton, *pair.follower);
    if (std::count(leaders.begin(), leaders.end(), 0.0f) > 0) continue;
    for (std::size_t b = 0; b < leaders.size(); ++b) {
      ratios[b].push_back(double{followers[b]} / double{leaders[b]});
    }
    sizes.push_back(std::accumulate(followers.begin(), followers.end(), 0.0) /
                    std::accumulate(leaders.begin(), leaders.end(), 0.0));
  }
  std::vector<double> medians;
  if (sizes.empty()) return medians;
  const bool smaller = base::Quantile(sizes, 0.9) <= 1 - kClearlyOther,
             larger = base::Quantile(sizes, 0.1) >= 1 + kClearlyOther;
  if (!smaller && !larger) return medians;
  for (const std::vector<double>& of_bone : ratios) medians.push_back(base::Median(of_bone));
  return medians;
}

}  // namespace duet::engine

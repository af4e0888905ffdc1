#include "model/cleanup/hand_contact.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "model/body/hands.h"
#include "model/cleanup/low_pass.h"
#include "model/cleanup/spacing.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;

constexpr double kHandSmoothSeconds = 0.1, kBodySmoothSeconds = 0.2;
// How far an arm reaches comfortably, in lengths of the arm.
constexpr float kComfortable = 0.9f;
// Metres. A shorter offset has no direction.
constexpr float kNoDirection = 1e-3f;
constexpr float kLeastOffer = 0.01f;

float Float(double value) { return static_cast<float>(value); }

// The two hands that meet, and how much in every frame.
struct Pair {
  const body::Limb* leader;
  const body::Limb* follower;
  std::vector<float> offers;  // [frames]
};

std::vector<float> Offers(const motion::Skeleton& skeleton, const body::Limb& arm,
                          const motion::Poses& leader, const Meetings& meetings,
                          const HandContactOptions& options, const motion::Poses& follower) {
  std::vector<float> offers(static_cast<std::size_t>(follower.frame_count()));
  for (int t = 0; t < follower.frame_count(); ++t) {
    const float weight = meetings[static_cast<std::size_t>(t)].weight;
    if (weight == 0) continue;
    const double reach =
        body::ReachTowards(arm, skeleton.root, leader[t], follower.at(t, skeleton.root));
    const float offered =
        SmoothStep((reach - options.answers_reach) / (options.meets_reach - options.answers_reach));
    offers[static_cast<std::size_t>(t)] = offered * weight;
  }
  return offers;
}

float Sum(const std::vector<float>& values) {
  float sum = 0;
  for (const float value : values) sum += value;
  return sum;
}

// The mean distance of two hands while one is offered, times the sum of the offers.
float WeightedDistance(const std::vector<float>& offers, const motion::Poses& leader, int from,
                       const motion::Poses& follower, int to) {
  float sum = 0;
  for (int t = 0; t < follower.frame_count(); ++t) {
    sum += offers[static_cast<std::size_t>(t)] * Distance(leader.at(t, from), follower.at(t, to));
  }
  return sum;
}

std::optional<Pair> FindPair(const motion::Skeleton& skeleton, const body::Body& body,
                             const motion::Poses& leader, const Meetings& meetings,
                             const HandContactOptions& options, const motion::Poses& follower) {
  if (!body.shoulders) return std::nullopt;
  Pair pair{&body.arms[0], nullptr,
            Offers(skeleton, body.arms[0], leader, meetings, options, follower)};
  std::vector<float> other = Offers(skeleton, body.arms[1], leader, meetings, options, follower);
  if (Sum(other) > Sum(pair.offers)) pair = {&body.arms[1], nullptr, std::move(other)};
  if (Sum(pair.offers) < kLeastOffer) return std::nullopt;
  const auto distance = [&](const body::Limb& arm) {
    return WeightedDistance(pair.offers, leader, pair.leader->end, follower, arm.end);
  };
  pair.follower = distance(body.arms[0]) <= distance(body.arms[1]) ? &body.arms[0] : &body.arms[1];
  return pair;
}

// Where the follower's hand meets the leader's in a frame.
Vec3 Target(const Pair& pair, absl::Span<const Vec3> leader, float metres,
            absl::Span<const Vec3> follower) {
  const Vec3 hand = leader[static_cast<std::size_t>(pair.leader->end)];
  const Vec3 way = follower[static_cast<std::size_t>(pair.follower->end)] - hand;
  if (Norm(way) < kNoDirection) return hand;
  return hand + way * (metres / Norm(way));
}

// `v`, not longer than `most`.
Vec3 Shortened(Vec3 v, float most) {
  const float length = Norm(v);
  return length > most ? v * (most / length) : v;
}

// The way of the body that lets the arm reach in a frame, along the floor.
Vec3 Approach(const Pair& pair, Vec3 target, absl::Span<const Vec3> pose) {
  const auto at = [&](int joint) { return pose[static_cast<std::size_t>(joint)]; };
  const body::Limb& arm = *pair.follower;
  const float length =
      Distance(at(arm.upper), at(arm.middle)) + Distance(at(arm.middle), at(arm.end));
  const Vec3 way = target - at(arm.upper), level = {way.x, 0, way.z};
  const float reach = kComfortable * length, rise = std::abs(way.y);
  const float across = rise < reach ? std::sqrt(reach * reach - rise * rise) : 0;
  if (Norm(level) <= across || Norm(level) < kNoDirection) return {};
  return level * (1 - across / Norm(level));
}

}  // namespace

void ApproachHand(const motion::Skeleton& skeleton, const body::Body& body,
                  const motion::Poses& leader, const Meetings& meetings,
                  const HandContactOptions& options, const Timing& timing,
                  motion::Poses* follower) {
  const auto pair = FindPair(skeleton, body, leader, meetings, options, *follower);
  if (!pair) return;
  std::vector<Vec3> shifts;
  shifts.reserve(pair->offers.size());
  for (int t = 0; t < follower->frame_count(); ++t) {
    const std::size_t at = static_cast<std::size_t>(t);
    const Vec3 target = Target(*pair, leader[t], meetings[at].metres, (*follower)[t]);
    shifts.push_back(
        Shortened(Approach(*pair, target, (*follower)[t]), Float(options.farthest_body_metres)) *
        pair->offers[at]);
  }
  shifts = LowPass(shifts, timing.Frames(kBodySmoothSeconds));
  ShiftBody(shifts, options.fastest_metres_per_second, timing, follower);
}

void MeetHand(const motion::Skeleton& skeleton, const body::Body& body, const motion::Poses& leader,
              const Meetings& meetings, const HandContactOptions& options, const Timing& timing,
              motion::Poses* follower) {
  const auto pair = FindPair(skeleton, body, leader, meetings, options, *follower);
  if (!pair) return;
  std::vector<Vec3> ways;
  ways.reserve(pair->offers.size());
  for (int t = 0; t < follower->frame_count(); ++t) {
    const std::size_t at = static_cast<std::size_t>(t);
    const Vec3 target = Target(*pair, leader[t], meetings[at].metres, (*follower)[t]);
    ways.push_back(
        Shortened(target - follower->at(t, pair->follower->end), Float(options.farthest_metres)) *
        pair->offers[at]);
  }
  ways = LowPass(ways, timing.Frames(kHandSmoothSeconds));
  // What the settled frames lack must not come at once.
  const Vec3 lacks =
      timing.settled > 0 ? ways[static_cast<std::size_t>(timing.settled - 1)] : Vec3{};
  for (int t = timing.settled; t < follower->frame_count(); ++t) {
    const Vec3 way = ways[static_cast<std::size_t>(t)] - lacks * (1 - EaseIn(timing, t));
    const Vec3 backwards = -body::Facing(*skeleton.hips, (*follower)[t]);
    Reach(*pair->follower, follower->at(t, pair->follower->end) + way, backwards, (*follower)[t]);
  }
}

}  // namespace duet::cleanup

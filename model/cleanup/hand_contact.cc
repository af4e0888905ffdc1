#include "model/cleanup/hand_contact.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
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
// The distance of a hand from its shoulder with the elbow bent as far as it goes (joint_ranges.h),
// in lengths of the arm.
constexpr float kNearest = 0.25f;
// Metres. A shorter offset has no direction.
constexpr float kNoDirection = 1e-3f;
constexpr float kLeastOffer = 0.01f;

// How smoothly the hands that meet are chosen over time, and from which difference on the choice
// changes: of offers, and of distances in metres.
constexpr double kChoiceSmoothSeconds = 0.3;
constexpr float kClearlyMore = 0.1f, kClearlyNearer = 0.1f;

float Float(double value) { return static_cast<float>(value); }

const body::Limb& ArmOf(const body::Body& body, int index) {
  return body.arms[static_cast<std::size_t>(index)];
}

// A hand of the leader and one of the follower that meet, in one frame.
struct Pair {
  int leader = 0, follower = 0;  // indices into body::Body::arms
};

// The hands that meet in every frame, and how much.
struct Offered {
  std::vector<Pair> pairs;    // [frames]
  std::vector<float> offers;  // [frames]; 0: no hand is offered
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

// The index of the larger of two tracks in every frame. Changes only where the other is larger by
// `clearly`, so that it does not change back and forth.
std::vector<int> Larger(const std::vector<float>& first, const std::vector<float>& second,
                        float clearly) {
  std::vector<int> larger;
  int now = first[0] >= second[0] ? 0 : 1;
  for (std::size_t t = 0; t < first.size(); ++t) {
    const float ahead = now == 0 ? second[t] - first[t] : first[t] - second[t];
    if (ahead > clearly) now = 1 - now;
    larger.push_back(now);
  }
  return larger;
}

// How near a hand of the follower is to the leader's hand that is offered, smooth over time.
std::vector<float> Nearness(const body::Body& body, const std::vector<int>& offered, int hand,
                            const motion::Poses& leader, const motion::Poses& follower,
                            double sigma_frames) {
  std::vector<float> nearness;
  for (int t = 0; t < follower.frame_count(); ++t) {
    const std::size_t arm = static_cast<std::size_t>(offered[static_cast<std::size_t>(t)]);
    nearness.push_back(-Distance(leader.at(t, body.arms[arm].end),
                                 follower.at(t, body.arms[static_cast<std::size_t>(hand)].end)));
  }
  return LowPass(nearness, sigma_frames);
}

// The leader's hand that is offered most at a time, and the follower's that is nearest to it then.
std::optional<Offered> FindHands(const motion::Skeleton& skeleton, const body::Body& body,
                                 const motion::Poses& leader, const Meetings& meetings,
                                 const HandContactOptions& options, const Timing& timing,
                                 const motion::Poses& follower) {
  if (!body.shoulders) return std::nullopt;
  std::vector<float> offers[2];
  float sum = 0;
  for (const std::size_t arm : {0u, 1u}) {
    offers[arm] = Offers(skeleton, body.arms[arm], leader, meetings, options, follower);
    sum += std::accumulate(offers[arm].begin(), offers[arm].end(), 0.0f);
  }
  if (sum < kLeastOffer) return std::nullopt;
  const double sigma = timing.Frames(kChoiceSmoothSeconds);
  const std::vector<int> offered =
      Larger(LowPass(offers[0], sigma), LowPass(offers[1], sigma), kClearlyMore);
  const std::vector<int> nearest =
      Larger(Nearness(body, offered, 0, leader, follower, sigma),
             Nearness(body, offered, 1, leader, follower, sigma), kClearlyNearer);
  Offered hands;
  for (std::size_t t = 0; t < offered.size(); ++t) {
    hands.pairs.push_back({offered[t], nearest[t]});
    hands.offers.push_back(offers[static_cast<std::size_t>(offered[t])][t]);
  }
  return hands;
}

// The longest vector within `reach` frames on either side, so that a body comes in time.
std::vector<Vec3> LongestAround(const std::vector<Vec3>& track, int reach) {
  const int frames = static_cast<int>(track.size());
  std::vector<Vec3> longest = track;
  for (int t = 0; t < frames; ++t) {
    for (int s = std::max(0, t - reach); s <= std::min(frames - 1, t + reach); ++s) {
      Vec3& now = longest[static_cast<std::size_t>(t)];
      const Vec3 other = track[static_cast<std::size_t>(s)];
      if (Dot(other, other) > Dot(now, now)) now = other;
    }
  }
  return longest;
}

// Where the follower's hand meets the leader's in a frame.
Vec3 Target(const body::Body& body, Pair pair, absl::Span<const Vec3> leader, float metres,
            absl::Span<const Vec3> follower) {
  const Vec3 hand = leader[static_cast<std::size_t>(ArmOf(body, pair.leader).end)];
  const Vec3 way = follower[static_cast<std::size_t>(ArmOf(body, pair.follower).end)] - hand;
  if (Norm(way) < kNoDirection) return hand;
  return hand + way * (metres / Norm(way));
}

// `target`, or the nearest point to which the arm reaches without folding its elbow.
Vec3 Unfolded(const body::Limb& arm, Vec3 target, absl::Span<const Vec3> pose) {
  const auto at = [&](int joint) { return pose[static_cast<std::size_t>(joint)]; };
  const float least =
      kNearest * (Distance(at(arm.upper), at(arm.middle)) + Distance(at(arm.middle), at(arm.end)));
  const Vec3 way = target - at(arm.upper);
  const float length = Norm(way);
  return length < least && length > kNoDirection ? at(arm.upper) + way * (least / length) : target;
}

// `v`, not longer than `most`.
Vec3 Shortened(Vec3 v, float most) {
  const float length = Norm(v);
  return length > most ? v * (most / length) : v;
}

// The way of the body that lets the arm reach in a frame, along the floor.
Vec3 Approach(const body::Limb& arm, Vec3 target, absl::Span<const Vec3> pose) {
  const auto at = [&](int joint) { return pose[static_cast<std::size_t>(joint)]; };
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
  const auto hands = FindHands(skeleton, body, leader, meetings, options, timing, *follower);
  if (!hands) return;
  std::vector<Vec3> shifts;
  shifts.reserve(hands->offers.size());
  for (int t = 0; t < follower->frame_count(); ++t) {
    const std::size_t at = static_cast<std::size_t>(t);
    const Pair pair = hands->pairs[at];
    const Vec3 target = Target(body, pair, leader[t], meetings[at].metres, (*follower)[t]);
    shifts.push_back(Shortened(Approach(ArmOf(body, pair.follower), target, (*follower)[t]),
                               Float(options.farthest_body_metres)) *
                     hands->offers[at]);
  }
  shifts = LongestAround(shifts,
                         static_cast<int>(std::lround(timing.Frames(options.body_ahead_seconds))));
  shifts = LowPass(shifts, timing.Frames(kBodySmoothSeconds));
  ShiftBody(shifts, options.fastest_metres_per_second, timing, follower);
}

void MeetHand(const motion::Skeleton& skeleton, const body::Body& body, const motion::Poses& leader,
              const Meetings& meetings, const HandContactOptions& options, const Timing& timing,
              motion::Poses* follower) {
  const auto hands = FindHands(skeleton, body, leader, meetings, options, timing, *follower);
  if (!hands) return;
  const motion::Poses before = *follower;
  const std::vector<float> offers = MostAround(
      hands->offers, static_cast<int>(std::lround(timing.Frames(options.hand_ahead_seconds))));
  for (int hand = 0; hand < 2; ++hand) {
    const body::Limb& arm = ArmOf(body, hand);
    std::vector<Vec3> ways;
    ways.reserve(hands->offers.size());
    for (int t = 0; t < before.frame_count(); ++t) {
      const std::size_t at = static_cast<std::size_t>(t);
      ways.emplace_back();
      if (hands->pairs[at].follower != hand) continue;
      const Vec3 target =
          Unfolded(arm, Target(body, hands->pairs[at], leader[t], meetings[at].metres, before[t]),
                   before[t]);
      ways.back() =
          Shortened(target - before.at(t, arm.end), Float(options.farthest_metres)) * offers[at];
    }
    ways = LowPass(ways, timing.Frames(kHandSmoothSeconds));
    // What the settled frames lack must not come at once.
    const Vec3 lacks =
        timing.settled > 0 ? ways[static_cast<std::size_t>(timing.settled - 1)] : Vec3{};
    for (int t = timing.settled; t < follower->frame_count(); ++t) {
      const Vec3 way = ways[static_cast<std::size_t>(t)] - lacks * (1 - EaseIn(timing, t));
      const Vec3 backwards = -body::Facing(*skeleton.hips, (*follower)[t]);
      Reach(arm, before.at(t, arm.end) + way, backwards, (*follower)[t]);
    }
  }
}

}  // namespace duet::cleanup

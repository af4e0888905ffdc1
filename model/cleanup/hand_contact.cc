#include "model/cleanup/hand_contact.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "model/body/hands.h"
#include "model/cleanup/directions.h"
#include "model/cleanup/low_pass.h"
#include "model/cleanup/spacing.h"

namespace duet::cleanup {
namespace {

using motion::Vec3;

constexpr double kHandSmoothSeconds = 0.1, kBodySmoothSeconds = 0.2;
// How far an arm reaches comfortably, in lengths of the arm.
constexpr float kComfortable = 0.95f;
constexpr float kLeastOffer = 0.01f;

float Float(double value) { return static_cast<float>(value); }

using Weights = std::vector<float>;  // [frames]

// Frames [begin, end) in which a hand of the leader is offered, and the hand that meets it.
struct Offer {
  const body::Limb* leader = nullptr;
  const body::Limb* follower = nullptr;
  int begin = 0, end = 0;
};

// How much a hand of the leader is offered in each frame, and already `lead` frames before and
// after: hands that meet come in time.
Weights OffersOf(const motion::Skeleton& skeleton, const body::Limb& arm,
                 const motion::Poses& leader, const Meetings& meetings,
                 const HandContactOptions& options, double lead, const motion::Poses& follower) {
  Weights offers(static_cast<std::size_t>(follower.frame_count()));
  for (int t = 0; t < follower.frame_count(); ++t) {
    const float weight = meetings[static_cast<std::size_t>(t)].weight;
    if (weight == 0) continue;
    const double reach =
        body::ReachTowards(arm, skeleton.root, leader[t], follower.at(t, skeleton.root));
    const float offered =
        SmoothStep((reach - options.answers_reach) / (options.meets_reach - options.answers_reach));
    offers[static_cast<std::size_t>(t)] = offered * weight;
  }
  return lead > 0 ? MostAround(offers, static_cast<int>(std::lround(lead))) : offers;
}

float Sum(const Weights& values, int begin, int end) {
  return std::accumulate(values.begin() + begin, values.begin() + end, 0.0f);
}

// The mean distance of two hands during an offer, times the sum of its weights.
float WeightedDistance(const Offer& offer, const Weights& weights, const motion::Poses& leader,
                       const motion::Poses& follower, int hand) {
  float sum = 0;
  for (int t = offer.begin; t < offer.end; ++t) {
    sum += weights[static_cast<std::size_t>(t)] *
           Distance(leader.at(t, offer.leader->end), follower.at(t, hand));
  }
  return sum;
}

// The offers of both hands of the leader, in the order of their frames, and how much each frame
// belongs to one. Where both hands are offered, the one that is offered more counts.
struct Offers {
  std::vector<Offer> list;
  Weights weights;  // [frames]
};

// The stretches in which one of two hands is offered more than the other.
Offers Stretches(const body::Body& body, const std::vector<Weights>& hands) {
  Offers offers;
  const int frames = static_cast<int>(hands[0].size());
  offers.weights.resize(hands[0].size());
  const auto longer = [&](int arm, int t) {  // the sum of the hand's stretch that contains t
    const Weights& hand = hands[static_cast<std::size_t>(arm)];
    int begin = t, end = t;
    while (begin > 0 && hand[static_cast<std::size_t>(begin - 1)] > 0) --begin;
    while (end < frames && hand[static_cast<std::size_t>(end)] > 0) ++end;
    return Sum(hand, begin, end);
  };
  int now = -1;
  for (int t = 0; t < frames; ++t) {
    const std::size_t at = static_cast<std::size_t>(t);
    const bool first = hands[0][at] > 0, second = hands[1][at] > 0;
    int next = first ? 0 : second ? 1 : -1;
    if (first && second) next = longer(0, t) >= longer(1, t) ? 0 : 1;
    if (next != now && next >= 0) {
      offers.list.push_back({&body.arms[static_cast<std::size_t>(next)], nullptr, t, t});
    }
    now = next;
    if (now < 0) continue;
    offers.weights[at] = hands[static_cast<std::size_t>(now)][at];
    offers.list.back().end = t + 1;
  }
  return offers;
}

Offers FindOffers(const motion::Skeleton& skeleton, const body::Body& body,
                  const motion::Poses& leader, const Meetings& meetings,
                  const HandContactOptions& options, double lead, const motion::Poses& follower) {
  if (!body.shoulders) return {};
  std::vector<Weights> hands;
  for (const body::Limb& arm : body.arms) {
    hands.push_back(OffersOf(skeleton, arm, leader, meetings, options, lead, follower));
  }
  Offers offers = Stretches(body, hands);
  for (Offer& offer : offers.list) {
    const auto distance = [&](const body::Limb& arm) {
      return WeightedDistance(offer, offers.weights, leader, follower, arm.end);
    };
    offer.follower =
        distance(body.arms[0]) <= distance(body.arms[1]) ? &body.arms[0] : &body.arms[1];
  }
  const int frames = static_cast<int>(offers.weights.size());
  if (Sum(offers.weights, 0, frames) < kLeastOffer) return {};
  return offers;
}

// Where the follower's hand meets the leader's in a frame.
Vec3 Target(const Offer& pair, absl::Span<const Vec3> leader, float metres,
            absl::Span<const Vec3> follower) {
  const Vec3 hand = leader[static_cast<std::size_t>(pair.leader->end)];
  const Vec3 way = follower[static_cast<std::size_t>(pair.follower->end)] - hand;
  if (Norm(way) < kNoOffset) return hand;
  return hand + way * (metres / Norm(way));
}

// `v`, not longer than `most`.
Vec3 Shortened(Vec3 v, float most) {
  const float length = Norm(v);
  return length > most ? v * (most / length) : v;
}

// The way of the body that lets the arm reach in a frame, along the floor, without its last part.
Vec3 Approach(const Offer& pair, Vec3 target, float left_out, absl::Span<const Vec3> pose) {
  const auto at = [&](int joint) { return pose[static_cast<std::size_t>(joint)]; };
  const body::Limb& arm = *pair.follower;
  const float length = LengthOf(arm, pose);
  const Vec3 way = target - at(arm.upper), level = {way.x, 0, way.z};
  const float reach = kComfortable * length, rise = std::abs(way.y);
  const float across = rise < reach ? std::sqrt(reach * reach - rise * rise) : 0;
  const float near = across + left_out;
  if (Norm(level) <= near || Norm(level) < kNoOffset) return {};
  return level * (1 - near / Norm(level));
}

}  // namespace

void ApproachHand(const motion::Skeleton& skeleton, const body::Body& body,
                  const motion::Poses& leader, const Meetings& meetings,
                  const HandContactOptions& options, const Timing& timing,
                  motion::Poses* follower) {
  const Offers offers = FindOffers(skeleton, body, leader, meetings, options,
                                   timing.Frames(options.body_lead_seconds), *follower);
  if (offers.list.empty()) return;
  std::vector<Vec3> shifts(static_cast<std::size_t>(follower->frame_count()));
  for (const Offer& offer : offers.list) {
    for (int t = offer.begin; t < offer.end; ++t) {
      const std::size_t at = static_cast<std::size_t>(t);
      const Vec3 target = Target(offer, leader[t], meetings[at].metres, (*follower)[t]);
      const Vec3 way = Approach(offer, target, meetings[at].left_out_metres, (*follower)[t]);
      shifts[at] = Shortened(way, Float(options.farthest_body_metres)) * offers.weights[at];
    }
  }
  shifts = LowPass(shifts, timing.Frames(kBodySmoothSeconds));
  ShiftBody(shifts, options.fastest_metres_per_second, timing, follower);
}

void MeetHand(const motion::Skeleton& skeleton, const body::Body& body, const motion::Poses& leader,
              const Meetings& meetings, const HandContactOptions& options, const Timing& timing,
              motion::Poses* follower) {
  const Offers offers = FindOffers(skeleton, body, leader, meetings, options,
                                   timing.Frames(options.hand_lead_seconds), *follower);
  if (offers.list.empty()) return;
  for (const body::Limb& arm : body.arms) {
    std::vector<Vec3> ways(static_cast<std::size_t>(follower->frame_count()));
    bool meets = false;
    for (const Offer& offer : offers.list) {
      if (offer.follower != &arm) continue;
      meets = true;
      for (int t = offer.begin; t < offer.end; ++t) {
        const std::size_t at = static_cast<std::size_t>(t);
        const Vec3 target = Target(offer, leader[t], meetings[at].metres, (*follower)[t]);
        ways[at] = Shortened(target - follower->at(t, arm.end), Float(options.farthest_metres)) *
                   offers.weights[at];
      }
    }
    if (!meets) continue;
    ways = LowPass(ways, timing.Frames(kHandSmoothSeconds));
    // What the settled frames lack must not come at once.
    const Vec3 lacks =
        timing.settled > 0 ? ways[static_cast<std::size_t>(timing.settled - 1)] : Vec3{};
    for (int t = timing.settled; t < follower->frame_count(); ++t) {
      const Vec3 way = ways[static_cast<std::size_t>(t)] - lacks * (1 - EaseIn(timing, t));
      const Vec3 backwards = -body::Facing(*skeleton.hips, (*follower)[t]);
      Reach(arm, follower->at(t, arm.end) + way, backwards, (*follower)[t]);
    }
  }
}

}  // namespace duet::cleanup

#include "model/solver/partner.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "absl/types/span.h"
#include "model/base/angle.h"
#include "model/body/contact.h"
#include "model/motion/capsules.h"
#include "model/motion/filter.h"
#include "model/solver/geometry.h"
#include "model/solver/smoother.h"

namespace duet::solver {
namespace {

using motion::Vec3;

constexpr Vec3 kUp{0, 1, 0};
// Distances and directions are judged by their mean over this time. Seconds, deviation.
constexpr double kLastingSeconds = 0.45;
// The distance of the roots along the floor: nearest in an embrace, farthest within reach of a few
// steps. Metres.
constexpr float kNearest = 0.17f, kFarthest = 2.6f;
// Radii of trunk, head and shoulders, and how far they may overlap, because clothes yield and
// capsules are approximate; the least distance of the axes of trunks, and of heads. Metres.
constexpr float kTrunk = 0.11f, kHead = 0.09f, kShoulders = 0.1f, kSoft = 0.03f;
constexpr float kLeastTrunks = 0.2f, kLeastHeads = 0.21f;
// Axes that are farther apart than any of these sums do not overlap. Metres.
constexpr float kNeverCloser = 0.25f;
// What a body is moved for one overlap at most; how far it comes for a hand. Metres.
constexpr float kMostPush = 0.3f, kMostCome = 0.3f;
// A hand is farther than this from the leader's surface; its radius is within. Metres.
constexpr float kHandRadius = 0.045f;
// The reach (body::ReachTowards) at which a hand begins to be met, and at which it is.
constexpr double kAnswers = 0.55, kMeets = 0.8;
// How far an arm reaches without effort, in its lengths.
constexpr float kComfortable = 0.9f;
// An embrace: the distance of the roots, and that of a hand from its place on the trunk, at which
// the hand is brought there, and at which it is left alone. Metres.
constexpr float kEmbraced = 0.45f, kApart = 0.7f, kHeld = 0.4f, kFree = 0.8f;
// How far an arm reaches around a trunk, in its lengths.
constexpr float kAround = 0.95f;
// Corrections come and go over these times. Seconds.
constexpr double kBodySeconds = 0.25, kTurnSeconds = 0.4, kHandSeconds = 0.1, kHoldSeconds = 0.2;
constexpr double kNear = 0.02, kIdle = 0.1;
constexpr int kRounds = 2;

struct Capsule {
  Vec3 from, to;
  float radius;
};
using Core = std::array<Capsule, 3>;  // trunk, head, shoulders

Core CoreOf(const motion::Skeleton& skeleton, const body::Body& body, absl::Span<const Vec3> pose) {
  const Vec3 chest = JointAt(pose, *body.chest);
  const Vec3 hips =
      Lerp(JointAt(pose, skeleton.hips->left), JointAt(pose, skeleton.hips->right), 0.5f);
  const Vec3 head = body.neck ? JointAt(pose, body.neck->head) : chest;
  return {
      {{chest, hips, kTrunk},
       {head, Lerp(head, chest, 0.5f), kHead},
       {JointAt(pose, body.shoulders->left), JointAt(pose, body.shoulders->right), kShoulders}}};
}

// A circle on the floor around a core's axes.
struct Circle {
  Vec3 centre;
  float radius;
};

Circle CircleAround(const Core& core) {
  const Vec3 centre = Lerp(core[0].from, core[0].to, 0.5f);
  float squared = 0;
  for (const Capsule& part : core) {
    for (const Vec3 end : {part.from, part.to}) {
      const Vec3 away = Level(end - centre);
      squared = std::max(squared, Dot(away, away));
    }
  }
  return {centre, std::sqrt(squared)};
}

// Where the trunk faces along the floor, of length 1.
Vec3 FacingOf(const motion::Skeleton& skeleton, const body::Body& body,
              absl::Span<const Vec3> pose) {
  const auto across = [&](const motion::JointPair& pair) {
    return Unit(Level(JointAt(pose, pair.left) - JointAt(pose, pair.right)));
  };
  return Unit(Cross(across(*skeleton.hips) + across(*body.shoulders), kUp));
}

// Weights of wishes: frames without one hardly count.
std::vector<double> WeightsOf(const std::vector<Vec3>& wishes) {
  std::vector<double> weights;
  for (const Vec3 wish : wishes) weights.push_back(wish == Vec3{} ? kIdle : 1);
  return weights;
}

float SmoothStep(double t) {
  const float u = static_cast<float>(std::clamp(t, 0.0, 1.0));
  return u * u * (3 - 2 * u);
}

// 1 up to `near`, 0 from `far` on.
float Nearness(float distance, float near, float far) {
  return SmoothStep(double{(far - distance) / (far - near)});
}

// A vector of at most a length, nearly unchanged while it is shorter. Smooth.
Vec3 Within(Vec3 v, float most) {
  const float share = Norm(v) / most;
  return v / std::pow(1 + std::pow(share, 8.0f), 0.125f);
}

}  // namespace

Vec3 TrunkAxes::PlaceOf(Vec3 joint) const {
  const Vec3 from = (joint - hips) / length;
  return {Dot(from, across), Dot(from, up), Dot(from, forward)};
}

Vec3 TrunkAxes::WorldOf(Vec3 place) const {
  return hips + (across * place.x + up * place.y + forward * place.z) * length;
}

TrunkAxes TrunkAxesOf(const motion::Skeleton& skeleton, const body::Body& body,
                      absl::Span<const Vec3> pose) {
  const auto line = [&](const motion::JointPair& pair) {
    return Unit(JointAt(pose, pair.left) - JointAt(pose, pair.right));
  };
  TrunkAxes axes;
  axes.hips = Lerp(JointAt(pose, skeleton.hips->left), JointAt(pose, skeleton.hips->right), 0.5f);
  const Vec3 trunk = JointAt(pose, *body.chest) - axes.hips;
  axes.length = std::max(Norm(trunk), kNoDirection);
  axes.up = Unit(trunk);
  axes.across = Unit(Across(line(*skeleton.hips) + line(*body.shoulders), axes.up));
  axes.forward = Cross(axes.across, axes.up);
  return axes;
}

std::vector<double> DegreesAway(const motion::Skeleton& skeleton, const body::Body& body,
                                const motion::Poses& leader, const motion::Poses& follower,
                                double frame_rate_hz) {
  const int frames = follower.frame_count();
  motion::Poses views(frames, 2);  // where the follower faces, and where its leader is
  for (int t = 0; t < frames; ++t) {
    views.at(t, 0) = FacingOf(skeleton, body, follower[t]);
    views.at(t, 1) = Level(leader.at(t, skeleton.root) - follower.at(t, skeleton.root));
  }
  views = motion::GaussianFilter(views, kLastingSeconds * frame_rate_hz);
  std::vector<double> degrees;
  double last = 0;
  for (int t = 0; t < frames; ++t) {
    const double away = AngleAbout(kUp, views.at(t, 0), views.at(t, 1)) * base::kDegreesPerRadian;
    last += std::remainder(away - last, 360);
    degrees.push_back(last);
  }
  return degrees;
}

void Partner::FaceLeader(const motion::Poses& leader, const ContactRules& rules,
                         double frame_rate_hz, int given, motion::Poses* follower) const {
  std::vector<double> wishes, weights;
  bool turned_away = false;
  for (const double away : DegreesAway(skeleton_, body_, leader, *follower, frame_rate_hz)) {
    const double most = double{rules[wishes.size()].away_degrees};
    const double excess = (away - std::clamp(away, -most, most)) * base::kRadiansPerDegree;
    turned_away = turned_away || excess != 0;
    wishes.push_back(excess);
    weights.push_back(excess != 0 ? 1 : kIdle);
  }
  if (!turned_away) return;
  const std::vector<double> turns =
      SmoothCorrection({frame_rate_hz, kTurnSeconds, kNear, given}, weights, wishes);
  for (int t = given; t < follower->frame_count(); ++t) {
    const Vec3 root = follower->at(t, skeleton_.root);
    for (Vec3& joint : (*follower)[t]) {
      joint = root + RotateY(joint - root, turns[static_cast<std::size_t>(t)]);
    }
  }
}

float Partner::Overlap(absl::Span<const Vec3> leader, absl::Span<const Vec3> follower,
                       float allowed) const {
  const Core a = CoreOf(skeleton_, body_, leader), b = CoreOf(skeleton_, body_, follower);
  const Circle around_a = CircleAround(a), around_b = CircleAround(b);
  const float apart = Norm(Level(around_a.centre - around_b.centre));
  if (apart > around_a.radius + around_b.radius + kNeverCloser) return 0;
  float deepest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) {
      float need = (a[i].radius + b[j].radius - kSoft) * (1 - allowed);
      if (i == 0 && j == 0) need = std::max(need, kLeastTrunks);
      if (i == 1 && j == 1) need = std::max(need, kLeastHeads);
      const motion::ClosestPoints closest =
          motion::FindClosestPoints(a[i].from, a[i].to, b[j].from, b[j].to);
      deepest = std::max(deepest, need - static_cast<float>(closest.distance));
    }
  }
  return std::min(deepest, kMostPush);
}

Vec3 Partner::WayForHand(const Meeting& meeting, const motion::Poses& leader,
                         const ContactRules& rules, int t, const motion::Poses& follower) const {
  const std::size_t at = static_cast<std::size_t>(t);
  const Vec3 hand = leader.at(t, meeting.leader->end);
  const Vec3 way = Level(hand - follower.at(t, meeting.follower->upper));
  const float reach = kComfortable * body::LengthOf(*meeting.follower, follower[t]);
  const float lacks = Norm(way) - reach - rules[at].hands_metres;
  return Unit(way) * (meeting.weights[at] * std::clamp(lacks, 0.0f, kMostCome));
}

void Partner::PlaceBody(const motion::Poses& leader, const ContactRules& rules,
                        double frame_rate_hz, int given, motion::Poses* follower) const {
  FaceLeader(leader, rules, frame_rate_hz, given, follower);
  const int frames = follower->frame_count();
  const std::vector<Meeting> meetings = FindMeetings(leader, rules, frame_rate_hz, *follower);
  for (int round = 0; round < kRounds; ++round) {
    motion::Poses offsets(frames, 1);
    for (int t = 0; t < frames; ++t) {
      offsets.at(t, 0) = Level(follower->at(t, skeleton_.root) - leader.at(t, skeleton_.root));
    }
    const motion::Poses lasting = motion::GaussianFilter(offsets, kLastingSeconds * frame_rate_hz);
    std::vector<Vec3> wishes;
    for (int t = 0; t < frames; ++t) {
      const Vec3 offset = lasting.at(t, 0);
      const float distance = Norm(offset);
      Vec3 wish = Unit(offset) * (std::clamp(distance, kNearest, kFarthest) - distance);
      for (const Meeting& meeting : meetings) {
        wish += WayForHand(meeting, leader, rules, t, *follower);
      }
      const float deep =
          Overlap(leader[t], (*follower)[t], rules[static_cast<std::size_t>(t)].overlap);
      const Vec3 out = Unit(offsets.at(t, 0));
      if (deep > 0) wish += (out == Vec3{} ? Vec3{0, 0, 1} : out) * deep;
      wishes.push_back(wish);
    }
    const std::vector<Vec3> shifts =
        SmoothShift({frame_rate_hz, kBodySeconds, kNear, given}, WeightsOf(wishes), wishes);
    for (int t = given; t < frames; ++t) {
      for (Vec3& joint : (*follower)[t]) joint += shifts[static_cast<std::size_t>(t)];
    }
  }
}

const body::Limb* Partner::NearestArm(const Meeting& meeting, const motion::Poses& leader,
                                      const motion::Poses& follower) const {
  const body::Limb* nearest = nullptr;
  float least = HUGE_VALF;
  for (const body::Limb& arm : body_.arms) {
    float sum = 0;
    for (int t = 0; t < follower.frame_count(); ++t) {
      sum += meeting.weights[static_cast<std::size_t>(t)] *
             Distance(leader.at(t, meeting.leader->end), follower.at(t, arm.end));
    }
    if (sum >= least) continue;
    least = sum;
    nearest = &arm;
  }
  return nearest;
}

std::vector<Partner::Meeting> Partner::FindMeetings(const motion::Poses& leader,
                                                    const ContactRules& rules, double frame_rate_hz,
                                                    const motion::Poses& follower) const {
  const int frames = follower.frame_count();
  motion::Poses offers(frames, 2);  // x: how much each hand of the leader is offered
  for (int t = 0; t < frames; ++t) {
    for (int arm = 0; arm < 2; ++arm) {
      const double reach =
          body::ReachTowards(body_.arms[static_cast<std::size_t>(arm)], skeleton_.root, leader[t],
                             follower.at(t, skeleton_.root));
      offers.at(t, arm).x = rules[static_cast<std::size_t>(t)].hands *
                            SmoothStep((reach - kAnswers) / (kMeets - kAnswers));
    }
  }
  offers = motion::GaussianFilter(offers, kHandSeconds * frame_rate_hz);
  std::vector<Meeting> meetings;
  for (int arm = 0; arm < 2; ++arm) {
    Meeting meeting{&body_.arms[static_cast<std::size_t>(arm)], nullptr, {}};
    bool meets = false;
    for (int t = 0; t < frames; ++t) {
      const float own = offers.at(t, arm).x, other = offers.at(t, 1 - arm).x;
      const bool more = own > other || (own == other && arm == 0);
      meeting.weights.push_back(more ? std::max(0.0f, own) : 0);
      meets = meets || meeting.weights.back() > 0;
    }
    if (!meets) continue;
    meeting.follower = NearestArm(meeting, leader, follower);
    meetings.push_back(std::move(meeting));
  }
  return meetings;
}

Vec3 Partner::WayToMeet(const Meeting& meeting, const motion::Poses& leader, float metres, int t,
                        const motion::Poses& follower) const {
  const Vec3 way = leader.at(t, meeting.leader->end) - follower.at(t, meeting.follower->end);
  return Unit(way) * std::max(0.0f, Norm(way) - metres);
}

void Partner::PlaceHands(const motion::Poses& leader, const ContactRules& rules,
                         double frame_rate_hz, int given, motion::Poses* follower) const {
  const std::vector<Meeting> meetings = FindMeetings(leader, rules, frame_rate_hz, *follower);
  for (int round = 0; round < kRounds; ++round) {
    MoveHands(meetings, leader, rules, frame_rate_hz, given, follower);
  }
  for (std::size_t arm = 0; arm < body_.arms.size(); ++arm) {
    HoldTrunk(arm, leader, rules, frame_rate_hz, given, follower);
  }
}

void Partner::HoldTrunk(std::size_t arm, const motion::Poses& leader, const ContactRules& rules,
                        double frame_rate_hz, int given, motion::Poses* follower) const {
  const body::Limb& limb = body_.arms[arm];
  const int frames = follower->frame_count();
  motion::Poses weights(frames, 1);  // x
  std::vector<Vec3> places;
  bool holds = false;
  for (int t = 0; t < frames; ++t) {
    const TrunkHold& hold = rules[static_cast<std::size_t>(t)].holds[arm];
    places.push_back(TrunkAxesOf(skeleton_, body_, leader[t]).WorldOf(hold.place));
    const float apart = Norm(Level(leader.at(t, skeleton_.root) - follower->at(t, skeleton_.root)));
    weights.at(t, 0).x = hold.weight * Nearness(apart, kEmbraced, kApart) *
                         Nearness(Distance(places.back(), follower->at(t, limb.end)), kHeld, kFree);
    holds = holds || weights.at(t, 0).x > 0;
  }
  if (!holds) return;
  weights = motion::GaussianFilter(weights, kHoldSeconds * frame_rate_hz);
  for (int round = 0; round < kRounds; ++round) {
    std::vector<double> pulls;
    std::vector<Vec3> wishes;
    for (int t = 0; t < frames; ++t) {
      const Vec3 shoulder = follower->at(t, limb.upper);
      const float reach = kAround * body::LengthOf(limb, (*follower)[t]);
      const Vec3 place = shoulder + Within(places[static_cast<std::size_t>(t)] - shoulder, reach);
      const float weight = weights.at(t, 0).x, pull = weight + static_cast<float>(kIdle);
      pulls.push_back(double{pull});
      wishes.push_back((place - follower->at(t, limb.end)) * (weight / pull));
    }
    const std::vector<Vec3> ways =
        SmoothShift({frame_rate_hz, kHoldSeconds, kNear, given}, pulls, wishes);
    for (int t = given; t < frames; ++t) {
      MoveHand(limb, ways[static_cast<std::size_t>(t)], (*follower)[t]);
    }
  }
}

// An elbow without a side of its own points down and back.
void Partner::MoveHand(const body::Limb& arm, Vec3 way, absl::Span<Vec3> pose) const {
  const Vec3 bend =
      body::BendOf(arm, pose) - FacingOf(skeleton_, body_, pose) * 0.02f - kUp * 0.02f;
  body::ReachBent(arm, JointAt(pose, arm.end) + way, bend, pose);
}

void Partner::MoveHands(const std::vector<Meeting>& meetings, const motion::Poses& leader,
                        const ContactRules& rules, double frame_rate_hz, int given,
                        motion::Poses* follower) const {
  for (const body::Limb& arm : body_.arms) {
    std::vector<Vec3> wishes;
    bool moves = false;
    for (int t = 0; t < follower->frame_count(); ++t) {
      const std::size_t at = static_cast<std::size_t>(t);
      Vec3 wish;
      const Vec3 hand = follower->at(t, arm.end);
      for (const Capsule& part : CoreOf(skeleton_, body_, leader[t])) {
        const motion::ClosestPoints closest = motion::FindClosestPoints(
            part.from, part.to, hand, Lerp(hand, follower->at(t, arm.middle), 0.5f));
        const float depth =
            part.radius + kHandRadius - kSoft - static_cast<float>(closest.distance);
        if (depth > 0) {
          wish += Unit(closest.on_b - closest.on_a) * (depth * (1 - rules[at].overlap));
        }
      }
      for (const Meeting& meeting : meetings) {
        if (meeting.follower != &arm) continue;
        wish +=
            WayToMeet(meeting, leader, rules[at].hands_metres, t, *follower) * meeting.weights[at];
      }
      moves = moves || wish != Vec3{};
      wishes.push_back(wish);
    }
    if (!moves) continue;
    const std::vector<Vec3> ways =
        SmoothShift({frame_rate_hz, kHandSeconds, kNear, given}, WeightsOf(wishes), wishes);
    for (int t = given; t < follower->frame_count(); ++t) {
      MoveHand(arm, ways[static_cast<std::size_t>(t)], (*follower)[t]);
    }
  }
}

}  // namespace duet::solver

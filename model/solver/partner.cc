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
// Bodies whose chests are farther apart than this along the floor do not overlap. Metres.
constexpr float kNeverOverlap = 2;
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
constexpr double kWholeWish = 0.03;  // a wish of this length has its whole weight, metres
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

// Where the trunk faces along the floor, of length 1.
Vec3 FacingOf(const motion::Skeleton& skeleton, const body::Body& body,
              absl::Span<const Vec3> pose) {
  const auto across = [&](const motion::JointPair& pair) {
    return Unit(Level(JointAt(pose, pair.left) - JointAt(pose, pair.right)));
  };
  return Unit(Cross(across(*skeleton.hips) + across(*body.shoulders), kUp));
}

// 1 up to `near`, 0 from `far` on.
float Nearness(float distance, float near, float far) {
  return SmoothStep((far - distance) / (far - near));
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

namespace {

// A hand of the leader that is met, by which hand, and how much in each frame.
struct Meeting {
  const body::Limb* leader = nullptr;
  const body::Limb* follower = nullptr;
  std::vector<float> weights;
};

// Corrects a follower, one rule after the other.
class Correction {
 public:
  Correction(const Encounter& encounter, motion::Poses* follower)
      : encounter_(encounter),
        skeleton_(encounter.skeleton),
        body_(encounter.body),
        leader_(encounter.leader),
        rate_(encounter.frame_rate_hz),
        follower_(*follower),
        frames_(follower->frame_count()) {}

  void FaceLeader() {
    std::vector<double> wishes, weights;
    bool turned_away = false;
    for (const double away : DegreesAway(skeleton_, body_, leader_, follower_, rate_)) {
      const double most = double{encounter_.rules[wishes.size()].away_degrees};
      const double excess = (away - std::clamp(away, -most, most)) * base::kRadiansPerDegree;
      turned_away = turned_away || excess != 0;
      wishes.push_back(excess);
      weights.push_back(excess != 0 ? 1 : kIdle);
    }
    if (!turned_away) return;
    const std::vector<double> turns = SmoothCorrection(Cost(kTurnSeconds), weights, wishes);
    for (int t = encounter_.given; t < frames_; ++t) {
      const Vec3 root = follower_.at(t, skeleton_.root);
      for (Vec3& joint : follower_[t]) {
        joint = root + RotateY(joint - root, turns[static_cast<std::size_t>(t)]);
      }
    }
  }

  // Keeps the body near, out of the leader, and within reach of the hands that it meets.
  void MoveBody() {
    const std::vector<Meeting> meetings = FindMeetings();
    for (int round = 0; round < kRounds; ++round) {
      motion::Poses offsets(frames_, 1);
      for (int t = 0; t < frames_; ++t) offsets.at(t, 0) = -ToLeader(t);
      const motion::Poses lasting = motion::GaussianFilter(offsets, kLastingSeconds * rate_);
      std::vector<Vec3> wishes;
      for (int t = 0; t < frames_; ++t) {
        const Vec3 offset = lasting.at(t, 0);
        const float distance = Norm(offset);
        Vec3 wish = Unit(offset) * (std::clamp(distance, kNearest, kFarthest) - distance);
        for (const Meeting& meeting : meetings) wish += WayForHand(meeting, t);
        const Vec3 out = Unit(offsets.at(t, 0));
        const float deep = Overlap(t);
        if (deep > 0) wish += (out == Vec3{} ? Vec3{0, 0, 1} : out) * deep;
        wishes.push_back(wish);
      }
      const std::vector<Vec3> shifts = Follow(wishes, kBodySeconds);
      for (int t = encounter_.given; t < frames_; ++t) {
        for (Vec3& joint : follower_[t]) joint += shifts[static_cast<std::size_t>(t)];
      }
    }
  }

  void MeetHands() {
    const std::vector<Meeting> meetings = FindMeetings();
    for (int round = 0; round < kRounds; ++round) {
      for (const body::Limb& arm : body_.arms) MoveHand(arm, meetings);
    }
  }

  // Brings a hand to where it rests on the leader's trunk, where both people are close and the hand
  // is near already. Weights and reach are smooth: rounding must not become a motion.
  void HoldTrunk(std::size_t arm) {
    const auto holds_here = [arm](const ContactRule& rule) { return rule.holds[arm].weight > 0; };
    if (std::none_of(encounter_.rules.begin(), encounter_.rules.end(), holds_here)) return;
    const body::Limb& limb = body_.arms[arm];
    motion::Poses weights(frames_, 1);  // x
    std::vector<Vec3> places;
    bool holds = false;
    for (int t = 0; t < frames_; ++t) {
      const TrunkHold& hold = RuleAt(t).holds[arm];
      places.push_back(TrunkAxesOf(skeleton_, body_, leader_[t]).WorldOf(hold.place));
      const float apart = Distance(places.back(), follower_.at(t, limb.end));
      float& weight = weights.at(t, 0).x;
      weight = hold.weight * Nearness(Norm(ToLeader(t)), kEmbraced, kApart) *
               Nearness(apart, kHeld, kFree);
      holds = holds || weight > 0;
    }
    if (!holds) return;
    weights = motion::GaussianFilter(weights, kHoldSeconds * rate_);
    for (int round = 0; round < kRounds; ++round) {
      std::vector<double> pulls;
      std::vector<Vec3> wishes;
      for (int t = 0; t < frames_; ++t) {
        const Vec3 shoulder = follower_.at(t, limb.upper);
        const float reach = kAround * body::LengthOf(limb, follower_[t]);
        const Vec3 place = shoulder + Within(places[static_cast<std::size_t>(t)] - shoulder, reach);
        const float weight = weights.at(t, 0).x, pull = weight + static_cast<float>(kIdle);
        pulls.push_back(double{pull});
        wishes.push_back((place - follower_.at(t, limb.end)) * (weight / pull));
      }
      MoveHand(limb, SmoothShift(Cost(kHoldSeconds), pulls, wishes));
    }
  }

 private:
  CorrectionCost Cost(double seconds) const { return {rate_, seconds, kNear, encounter_.given}; }
  // Frames without a wish hardly count, nor do those with one that rounding makes.
  std::vector<Vec3> Follow(const std::vector<Vec3>& wishes, double seconds) const {
    std::vector<double> weights;
    for (const Vec3 wish : wishes) {
      weights.push_back(kIdle + (1 - kIdle) * std::min(1.0, double{Norm(wish)} / kWholeWish));
    }
    return SmoothShift(Cost(seconds), weights, wishes);
  }
  const ContactRule& RuleAt(int t) const { return encounter_.rules[static_cast<std::size_t>(t)]; }
  // From the follower's root to the leader's, along the floor.
  Vec3 ToLeader(int t) const {
    return Level(leader_.at(t, skeleton_.root) - follower_.at(t, skeleton_.root));
  }

  float Overlap(int t) const {
    const Core a = CoreOf(skeleton_, body_, leader_[t]), b = CoreOf(skeleton_, body_, follower_[t]);
    if (Norm(Level(a[0].from - b[0].from)) > kNeverOverlap) return 0;
    float deepest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      for (std::size_t j = 0; j < b.size(); ++j) {
        float need = (a[i].radius + b[j].radius - kSoft) * (1 - RuleAt(t).overlap);
        if (i == 0 && j == 0) need = std::max(need, kLeastTrunks);
        if (i == 1 && j == 1) need = std::max(need, kLeastHeads);
        const motion::ClosestPoints closest =
            motion::FindClosestPoints(a[i].from, a[i].to, b[j].from, b[j].to);
        deepest = std::max(deepest, need - static_cast<float>(closest.distance));
      }
    }
    return std::min(deepest, kMostPush);
  }

  // The way of the body until the follower's hand reaches the leader's.
  Vec3 WayForHand(const Meeting& meeting, int t) const {
    const Vec3 way =
        Level(leader_.at(t, meeting.leader->end) - follower_.at(t, meeting.follower->upper));
    const float reach = kComfortable * body::LengthOf(*meeting.follower, follower_[t]);
    const float lacks = Norm(way) - reach - RuleAt(t).hands_metres;
    return Unit(way) *
           (meeting.weights[static_cast<std::size_t>(t)] * std::clamp(lacks, 0.0f, kMostCome));
  }

  // The hand that is nearest to the leader's while that is met.
  const body::Limb* NearestArm(const Meeting& meeting) const {
    const body::Limb* nearest = nullptr;
    float least = HUGE_VALF;
    for (const body::Limb& arm : body_.arms) {
      float sum = 0;
      for (int t = 0; t < frames_; ++t) {
        sum += meeting.weights[static_cast<std::size_t>(t)] *
               Distance(leader_.at(t, meeting.leader->end), follower_.at(t, arm.end));
      }
      if (sum >= least) continue;
      least = sum;
      nearest = &arm;
    }
    return nearest;
  }

  // One for each hand of the leader that is offered at any time, and more than the other one.
  std::vector<Meeting> FindMeetings() const {
    motion::Poses offers(frames_, 2);  // x: how much each hand of the leader is offered
    for (int t = 0; t < frames_; ++t) {
      for (int arm = 0; arm < 2; ++arm) {
        const double reach =
            body::ReachTowards(body_.arms[static_cast<std::size_t>(arm)], skeleton_.root,
                               leader_[t], follower_.at(t, skeleton_.root));
        offers.at(t, arm).x =
            RuleAt(t).hands *
            SmoothStep(static_cast<float>((reach - kAnswers) / (kMeets - kAnswers)));
      }
    }
    offers = motion::GaussianFilter(offers, kHandSeconds * rate_);
    std::vector<Meeting> meetings;
    for (int arm = 0; arm < 2; ++arm) {
      Meeting meeting{&body_.arms[static_cast<std::size_t>(arm)], nullptr, {}};
      bool meets = false;
      for (int t = 0; t < frames_; ++t) {
        const float own = offers.at(t, arm).x, other = offers.at(t, 1 - arm).x;
        const bool more = own > other || (own == other && arm == 0);
        meeting.weights.push_back(more ? std::max(0.0f, own) : 0);
        meets = meets || meeting.weights.back() > 0;
      }
      if (!meets) continue;
      meeting.follower = NearestArm(meeting);
      meetings.push_back(std::move(meeting));
    }
    return meetings;
  }

  // To the hands that it meets, and out of the leader.
  void MoveHand(const body::Limb& arm, const std::vector<Meeting>& meetings) {
    std::vector<Vec3> wishes;
    bool moves = false;
    for (int t = 0; t < frames_; ++t) {
      Vec3 wish;
      const Vec3 hand = follower_.at(t, arm.end);
      for (const Capsule& part : CoreOf(skeleton_, body_, leader_[t])) {
        const motion::ClosestPoints closest = motion::FindClosestPoints(
            part.from, part.to, hand, Lerp(hand, follower_.at(t, arm.middle), 0.5f));
        const float depth =
            part.radius + kHandRadius - kSoft - static_cast<float>(closest.distance);
        if (depth > 0) {
          wish += Unit(closest.on_b - closest.on_a) * (depth * (1 - RuleAt(t).overlap));
        }
      }
      for (const Meeting& meeting : meetings) {
        if (meeting.follower != &arm) continue;
        const Vec3 way = leader_.at(t, meeting.leader->end) - hand;
        wish += Unit(way) * std::max(0.0f, Norm(way) - RuleAt(t).hands_metres) *
                meeting.weights[static_cast<std::size_t>(t)];
      }
      moves = moves || wish != Vec3{};
      wishes.push_back(wish);
    }
    if (moves) MoveHand(arm, Follow(wishes, kHandSeconds));
  }

  // An elbow without a side of its own points down and back.
  void MoveHand(const body::Limb& arm, const std::vector<Vec3>& ways) {
    for (int t = encounter_.given; t < frames_; ++t) {
      const absl::Span<Vec3> pose = follower_[t];
      const Vec3 bend =
          body::BendOf(arm, pose) - FacingOf(skeleton_, body_, pose) * 0.02f - kUp * 0.02f;
      body::ReachBent(arm, JointAt(pose, arm.end) + ways[static_cast<std::size_t>(t)], bend, pose);
    }
  }

  const Encounter& encounter_;
  const motion::Skeleton& skeleton_;
  const body::Body& body_;
  const motion::Poses& leader_;
  const double rate_;
  motion::Poses& follower_;
  const int frames_;
};

}  // namespace

void PlaceBody(const Encounter& encounter, motion::Poses* follower) {
  Correction correction(encounter, follower);
  correction.FaceLeader();
  correction.MoveBody();
}

void PlaceHands(const Encounter& encounter, motion::Poses* follower) {
  Correction correction(encounter, follower);
  correction.MeetHands();
  for (std::size_t arm = 0; arm < encounter.body.arms.size(); ++arm) correction.HoldTrunk(arm);
}

}  // namespace duet::solver

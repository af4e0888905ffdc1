#include "model/solver/follower.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "absl/types/span.h"
#include "model/motion/filter.h"
#include "model/solver/feet.h"
#include "model/solver/geometry.h"
#include "model/solver/pins.h"
#include "model/solver/smoother.h"

namespace duet::solver {
namespace {

using motion::Vec3;

// The time over which a motion leaves the difference from the given frames. Seconds.
constexpr double kJoinSeconds = 0.15;
constexpr double kJoinNear = 0.3;
constexpr double kGiven = 1e9;
// The share of the leader's frames in which its lower foot is below the floor.
constexpr double kFloorShare = 0.1;
// A told pose brings its own floor, so far from the leader's, metres; and its own lean, up to so
// many degrees, and so many more.
constexpr double kMostFloor = 0.1, kMostOwnLean = 20, kMoreLean = 4;
// A lower foot that is farther above the floor on average over about a second is no jump. Metres;
// seconds, deviation. The time over which the body comes down, and the weight of staying.
constexpr float kMostAboveFloor = 0.035f;
constexpr double kFloorSeconds = 0.45, kLiftSeconds = 0.15, kLiftNear = 0.02;
// The least distance of the two roots along the floor in any frame. Metres.
constexpr float kNearestRoots = 0.17f;
// A limb that bends less has no plane of its own: knees bend forwards, elbows down and back.
// Metres; shares of a direction.
constexpr float kClearBend = 0.05f, kDown = 0.8f, kBack = 0.6f;
// The planes of limbs turn over this time. Seconds, standard deviation.
constexpr double kBendSeconds = 0.1;

// The place of a foot: as planned, or drawn along the floor towards the hip as far as the leg needs
// it. The body does not come down to any foot (KeepStature).
Vec3 DrawnAlong(const body::Limb& leg, absl::Span<const Vec3> pose, Vec3 place) {
  const Vec3 way = place - JointAt(pose, leg.upper);
  const float length = body::LengthOf(leg, pose), level = Norm(Level(way));
  const float reach = std::sqrt(std::max(0.0f, length * length - way.y * way.y));
  return level <= reach ? place : place - Level(way) * (1 - reach / level);
}

}  // namespace

FollowerSolver::FollowerSolver(const motion::Skeleton& skeleton, double frame_rate_hz)
    : skeleton_(skeleton), frame_rate_hz_(frame_rate_hz), body_(body::FindBody(skeleton_)) {
  if (!skeleton_.hips || !skeleton_.feet || body_.legs.size() != 2 || !body_.chest ||
      !body_.shoulders) {
    return;
  }
  trunk_.emplace(skeleton_, body_);
  limbs_ = body_.legs;
  limbs_.insert(limbs_.end(), body_.arms.begin(), body_.arms.end());
}

void FollowerSolver::Join(const motion::Poses& given, motion::Poses* follower) const {
  const int known = given.frame_count(), frames = follower->frame_count();
  if (known == 0) return;
  const CorrectionCost cost{frame_rate_hz_, kJoinSeconds, kJoinNear};
  std::vector<double> weights(static_cast<std::size_t>(frames));
  std::fill_n(weights.begin(), known, kGiven);
  // The correction is a sum of what the last two given frames lead to. Earlier ones do not matter.
  std::vector<double> last(weights.size()), before(weights.size());
  last[static_cast<std::size_t>(known - 1)] = 1;
  if (known > 1) before[static_cast<std::size_t>(known - 2)] = 1;
  last = SmoothCorrection(cost, weights, last);
  before = SmoothCorrection(cost, weights, before);
  for (int joint = 0; joint < follower->joint_count(); ++joint) {
    const auto lacks = [&](int t) { return given.at(t, joint) - follower->at(t, joint); };
    const Vec3 a = lacks(known - 1), b = known > 1 ? lacks(known - 2) : Vec3{};
    for (int t = known; t < frames; ++t) {
      const std::size_t at = static_cast<std::size_t>(t);
      follower->at(t, joint) +=
          a * static_cast<float>(last[at]) + b * static_cast<float>(before[at]);
    }
  }
  std::copy(given.all().begin(), given.all().end(), follower->all().begin());
}

double FollowerSolver::FloorOf(const Situation& situation) const {
  const auto lower = [&](const motion::Poses& poses, int t) {
    return double{std::min(poses.at(t, body_.legs[0].end).y, poses.at(t, body_.legs[1].end).y)};
  };
  std::vector<double> heights;
  for (int t = 0; t < situation.leader.frame_count() - situation.hidden_frames; ++t) {
    heights.push_back(lower(situation.leader, t));
  }
  if (heights.empty()) heights.push_back(lower(situation.leader, 0));
  const auto low = heights.begin() +
                   static_cast<std::ptrdiff_t>(kFloorShare * static_cast<double>(heights.size()));
  std::nth_element(heights.begin(), low, heights.end());
  if (situation.given.frame_count() != 1) return *low;
  return std::clamp(lower(situation.given, 0), *low - kMostFloor, *low + kMostFloor);
}

double FollowerSolver::OwnLean(const Situation& situation) const {
  if (situation.given.frame_count() != 1) return 0;
  return std::min(kMostOwnLean, trunk_->LeanDegrees(situation.given, 0)) + kMoreLean;
}

void FollowerSolver::MoveToPins(const motion::Pins& pins, int given,
                                motion::Poses* follower) const {
  const PinnedBody pinned(skeleton_, body_, pins, frame_rate_hz_, given, *follower);
  pinned.Approach(follower);
  pinned.Place(follower);
}

void FollowerSolver::Solve(const Situation& situation, const BodyModel& person,
                           motion::Poses* follower) const {
  const int given = situation.given.frame_count(), frames = follower->frame_count();
  const auto fit = [&] {
    for (int t = given; t < frames; ++t) person.Fit((*follower)[t]);
  };
  fit();
  const Stretches stretches = MeasureStretches(body_.legs, *follower);
  trunk_->LimitTwist(frame_rate_hz_, given, follower);
  fit();
  trunk_->LimitLean(frame_rate_hz_, given, OwnLean(situation), follower);
  const Encounter encounter{skeleton_,       body_,          situation.leader,
                            situation.rules, frame_rate_hz_, given};
  PlaceBody(encounter, follower);
  const std::vector<motion::Poses> bends = SmoothBends(*follower);
  const PinnedBody pinned(skeleton_, body_, situation.pins, frame_rate_hz_, given, *follower);
  if (!situation.pins.empty()) pinned.Approach(follower);
  PlaceFeet(situation, stretches, follower);
  PlaceHands(encounter, follower);
  BendLimbs(bends, given, follower);
  if (!situation.pins.empty()) pinned.Place(follower);
}

std::vector<motion::Poses> FollowerSolver::SmoothBends(const motion::Poses& follower) const {
  std::vector<motion::Poses> all;
  for (const body::Limb& limb : limbs_) {
    const bool is_leg = all.size() < body_.legs.size();
    motion::Poses bends(follower.frame_count(), 1);
    for (int t = 0; t < follower.frame_count(); ++t) {
      const Vec3 facing = body::Facing(*skeleton_.hips, follower[t]);
      const Vec3 straight = is_leg ? facing : Vec3{0, -kDown, 0} - facing * kBack;
      Vec3 bend = body::BendOf(limb, follower[t]);
      // A knee never bends backwards.
      if (is_leg) bend -= facing * std::min(0.0f, Dot(bend, facing));
      bends.at(t, 0) = bend + straight * std::max(0.0f, kClearBend - Norm(bend));
    }
    all.push_back(motion::GaussianFilter(bends, kBendSeconds * frame_rate_hz_));
  }
  return all;
}

void FollowerSolver::BendLimbs(const std::vector<motion::Poses>& bends, int given,
                               motion::Poses* follower) const {
  for (std::size_t i = 0; i < limbs_.size(); ++i) {
    for (int t = given; t < follower->frame_count(); ++t) {
      body::ReachBent(limbs_[i], follower->at(t, limbs_[i].end), bends[i].at(t, 0), (*follower)[t]);
    }
  }
}

void FollowerSolver::StandOnFloor(double floor, int given, motion::Poses* follower) const {
  motion::Poses heights(follower->frame_count(), 1);  // of the lower foot above the floor
  for (int t = 0; t < follower->frame_count(); ++t) {
    heights.at(t, 0).y =
        std::min(follower->at(t, body_.legs[0].end).y, follower->at(t, body_.legs[1].end).y) -
        static_cast<float>(floor);
  }
  heights = motion::GaussianFilter(heights, kFloorSeconds * frame_rate_hz_);
  std::vector<double> wishes;
  for (const Vec3 height : heights.all()) {
    wishes.push_back(std::clamp(height.y, 0.0f, kMostAboveFloor) - height.y);
  }
  const std::vector<double> lifts =
      SmoothCorrection({frame_rate_hz_, kLiftSeconds, kLiftNear, given},
                       std::vector<double>(wishes.size(), 1), wishes);
  for (int t = given; t < follower->frame_count(); ++t) {
    const float lift = static_cast<float>(lifts[static_cast<std::size_t>(t)]);
    for (Vec3& joint : (*follower)[t]) joint.y += lift;
  }
}

void FollowerSolver::PlaceFeet(const Situation& situation, const Stretches& stretches,
                               motion::Poses* follower) const {
  const int given = situation.given.frame_count(), frames = follower->frame_count();
  const double floor = FloorOf(situation);
  StandOnFloor(floor, given, follower);
  std::array<FootPath, 2> feet, hips;
  for (std::size_t leg = 0; leg < 2; ++leg) {
    for (int t = 0; t < frames; ++t) {
      feet[leg].push_back(follower->at(t, body_.legs[leg].end));
      hips[leg].push_back(follower->at(t, body_.legs[leg].upper));
    }
  }
  const Footing footing = PlanSteps(feet, hips, given, frame_rate_hz_, floor);
  KeepStature(body_.legs, footing, stretches, frame_rate_hz_, given, follower);
  for (std::size_t leg = 0; leg < 2; ++leg) {
    const body::Limb& limb = body_.legs[leg];
    for (int t = given; t < frames; ++t) {
      const Vec3 facing = body::Facing(*skeleton_.hips, (*follower)[t]);
      const Vec3 place = footing.paths[leg][static_cast<std::size_t>(t)];
      body::Reach(limb, DrawnAlong(limb, (*follower)[t], place), facing, (*follower)[t]);
    }
  }
}

void KeepFeetBetween(const body::Body& body, absl::Span<const Vec3> before,
                     absl::Span<const Vec3> after, absl::Span<Vec3> pose) {
  for (const body::Limb& leg : body.legs) {
    const std::size_t foot = static_cast<std::size_t>(leg.end);
    for (float Vec3::*const coordinate : {&Vec3::x, &Vec3::y, &Vec3::z}) {
      const auto [low, high] = std::minmax(before[foot].*coordinate, after[foot].*coordinate);
      pose[foot].*coordinate = std::clamp(pose[foot].*coordinate, low, high);
    }
  }
}

void KeepApart(int root, absl::Span<const Vec3> leader, absl::Span<Vec3> follower) {
  const std::size_t at = static_cast<std::size_t>(root);
  const Vec3 offset = Level(follower[at] - leader[at]);
  if (Norm(offset) >= kNearestRoots) return;
  const Vec3 direction = offset == Vec3{} ? Vec3{0, 0, 1} : Unit(offset);
  for (Vec3& joint : follower) joint += direction * kNearestRoots - offset;
}

}  // namespace duet::solver

#include "model/evaluation/experiments/plausibility.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "model/base/angle.h"
#include "model/base/statistics.h"
#include "model/body/build.h"
#include "model/body/contact.h"
#include "model/body/grade.h"
#include "model/body/liveliness.h"
#include "model/body/passing_poses.h"
#include "model/body/posture.h"
#include "model/motion/filter.h"
#include "model/retargeting/rig_fitting.h"

namespace duet::evaluation::experiments {
namespace {

using motion::Poses;
using motion::Vec3;
using Pose = absl::Span<const Vec3>;

// A clip counts as twisted from this angle between shoulders and hips on, in any frame.
constexpr double kTwistedClipDegrees = 60;
// A limb that is bent at least this much has a plane.
constexpr double kBentDegrees = 20;
// Shoulders that tilt more than this against the trunk: a raised arm lifts its shoulder less.
constexpr double kShoulderDegrees = 30;
// A plane that turns more than this in a frame, or a joint that turns faster than this, is a fault.
constexpr double kPlaneDegrees = 45, kTurnDegreesPerSecond = 900;
// A hand or foot of the leader that is deeper than this in the follower's body passes through it.
constexpr double kThroughMetres = 0.05;
// Offered hands that stay farther apart than this are a fault.
constexpr double kHandsMetres = 0.25;

Vec3 At(Pose pose, int joint) { return pose[static_cast<std::size_t>(joint)]; }

double Mean(double sum, int count) { return count > 0 ? sum / count : NAN; }

// Whether a fist or a foot of the leader passes through the follower's body.
class Through {
 public:
  Through(const body::Body& body, const body::Surface& surface) : body_(body), surface_(surface) {}

  bool Add(Pose leader, Pose follower) {
    bool through = false;
    for (const std::vector<body::Limb>* limbs : {&body_.arms, &body_.legs}) {
      for (const body::Limb& limb : *limbs) {
        through |= surface_.Distance(At(leader, limb.end), follower) < -kThroughMetres;
      }
    }
    through_ += through;
    ++frames_;
    return through;
  }
  double share() const { return Mean(through_, frames_); }

 private:
  const body::Body& body_;
  const body::Surface& surface_;
  int through_ = 0, frames_ = 0;
};

double DegreesBetween(Vec3 a, Vec3 b) {
  return base::kDegreesPerRadian * std::atan2(double{Norm(Cross(a, b))}, double{Dot(a, b)});
}

// By how much the plane in which a limb bends turns about its upper bone from one frame to the
// next; 0 for a limb that is nearly straight.
double PlaneTurn(const body::Limb& limb, Pose before, Pose now) {
  const auto bones = [&](Pose pose) {
    return std::pair{At(pose, limb.middle) - At(pose, limb.upper),
                     At(pose, limb.end) - At(pose, limb.middle)};
  };
  const auto [upper_before, lower_before] = bones(before);
  const auto [upper, lower] = bones(now);
  if (DegreesBetween(upper_before, lower_before) < kBentDegrees) return 0;
  if (DegreesBetween(upper, lower) < kBentDegrees) return 0;
  const retargeting::Quaternion carry =
      retargeting::ShortestArc(Unit(retargeting::ToDouble(upper_before), {0, 1, 0}),
                               Unit(retargeting::ToDouble(upper), {0, 1, 0}), {1, 0, 0});
  const Vec3 plane =
      retargeting::ToFloat(Rotate(carry, retargeting::ToDouble(Cross(upper_before, lower_before))));
  return DegreesBetween(plane, Cross(upper, lower));
}

// The largest such turn of any limb in a frame.
double LargestPlaneTurn(const body::Body& body, const Poses& poses, int frame) {
  double largest = 0;
  if (frame == 0) return largest;
  for (const std::vector<body::Limb>* limbs : {&body.arms, &body.legs}) {
    for (const body::Limb& limb : *limbs) {
      largest = std::max(largest, PlaneTurn(limb, poses[frame - 1], poses[frame]));
    }
  }
  return largest;
}

double One(bool yes) { return yes ? 1 : 0; }

// The fastest turn of a joint of the rig against its parent in every frame, degrees per second.
std::vector<double> RigTurns(const motion::Skeleton& skeleton, const Poses& poses, double rate) {
  const retargeting::RigAnimation animation =
      retargeting::AnimateRig(skeleton, {skeleton.joint_names, rate, poses});
  std::vector<double> turns(animation.frames.size());
  for (std::size_t t = 1; t < turns.size(); ++t) {
    for (std::size_t j = 0; j < animation.rig.joints.size(); ++j) {
      const double angle =
          Angle(animation.frames[t - 1].rotations[j], animation.frames[t].rotations[j]);
      turns[t] = std::max(turns[t], base::kDegreesPerRadian * angle * rate);
    }
  }
  return turns;
}

// The largest distance of the two roots along the floor.
double FarthestRoots(const motion::Skeleton& skeleton, const Poses& leader, const Poses& follower) {
  double farthest = 0;
  for (int t = 0; t < leader.frame_count(); ++t) {
    const Vec3 apart = follower.at(t, skeleton.root) - leader.at(t, skeleton.root);
    farthest = std::max(farthest, std::hypot(double{apart.x}, double{apart.z}));
  }
  return farthest;
}

}  // namespace

Plausibility::Plausibility(const motion::Skeleton& skeleton)
    : skeleton_(skeleton), body_(body::FindBody(skeleton)), surface_(skeleton, body_) {}

bool Plausibility::possible() const { return body::PairMeter::CanMeasure(skeleton_, body_); }

std::vector<PairFigure> Plausibility::Figures() {
  return {{"twisted clips"},  {"twisted"}, {"shoulders"}, {"both feet"}, {"leader's"},
          {"heads"},          {"trunks"},  {"hands"},     {"distance"},  {"speed"},
          {"leader's speed"}, {"through"}, {"planes"},    {"turns"},     {"fastest turn", true},
          {"lean"},           {"facing"},  {"farthest"},  {"astride"},   {"held out"},
          {"hips off", true}, {"hips"},    {"knees"}};
}

std::vector<std::string> Plausibility::Notes() {
  return {
      "Twisted clips: share of answers in which shoulders and hips differ by more than 60 degrees "
      "in any frame. Twisted: share of frames above 45 degrees. Shoulders: share of frames in "
      "which the line of the shoulders tilts by more than 30 degrees against the trunk. Both feet: "
      "share of frames in "
      "which the slower ankle moves faster than 10 cm/s; leader's: the same of the leaders.",
      "Heads, trunks: share of frames in which the heads are nearer than 18 cm, the axes of the "
      "trunks nearer than 16 cm. Hands: mean distance of the nearest hands while the leader "
      "reaches one out, metres. Distance: of the roots, metres. Speed: of the joints, m/s.",
      "Through: share of frames in which a fist or foot of the leader is more than 5 cm inside the "
      "follower's trunk, head or legs.",
      "Planes: share of answers in which the plane of a bent arm or leg turns by more than 45 "
      "degrees in a frame. Turns: share of answers in which a joint of the rig turns faster than "
      "900 degrees a second; fastest turn: the fastest of all, degrees a second. Lean: largest of "
      "the trunk over one second, degrees.",
      "Facing: how far hips and shoulders are turned away from the leader, mean over the frames, "
      "degrees. Farthest: the largest distance of the roots in an answer, mean over the answers, "
      "metres.",
      "Astride: the longest time in an answer for which the feet stay farther apart than 0.75 "
      "lengths of the leg. Held out: the longest time for which a hand that neither reaches for "
      "the leader nor is near a hand of the leader stays higher than 0.3 lengths of the arm below "
      "its shoulder. Means over the answers, seconds.",
      "Hips off: by how much the hips are narrower or wider than their median width, as a share of "
      "it, in the worst frame of all answers. Hips: mean height of the hips above the lower foot, "
      "in lengths of the leg. Knees: mean bend, degrees."};
}

PairFigures Plausibility::Measure(const Poses& leader, const Poses& follower, double rate,
                                  const ClassContacts& contacts) const {
  body::PairMeter meter(skeleton_, body_, rate);
  body::GradeSum sum;
  Through limbs(body_, surface_);
  body::LongestPoses longest(skeleton_, body_);
  const std::vector<double> turns = RigTurns(skeleton_, follower, rate);
  double most_twisted = 0, shoulders = 0, heads = 0, trunks = 0, plane = 0;
  std::vector<double> hands;
  PairFigures figures;
  for (int t = 0; t < leader.frame_count(); ++t) {
    const body::FrameMeasures frame = meter.Add(leader[t], follower[t]);
    sum.Add(frame);
    most_twisted = std::max(most_twisted, frame.twist_degrees);
    const bool tilted = body::ShoulderTiltDegrees(skeleton_, body_, follower[t]) > kShoulderDegrees;
    shoulders += tilted;
    heads += frame.head_overlap > 0;
    trunks += frame.trunk_overlap > 0;
    const std::optional<double> apart =
        body::OfferedHandDistance(body_, skeleton_.root, leader[t], follower[t]);
    if (apart) hands.push_back(*apart);
    longest.Add(leader[t], follower[t]);
    const bool through = limbs.Add(leader[t], follower[t]);
    const double turned = LargestPlaneTurn(body_, follower, t);
    plane = std::max(plane, turned);
    const bool fast = turns[static_cast<std::size_t>(t)] > kTurnDegreesPerSecond;
    figures.faults.push_back(
        One(frame.twisted()) + One(tilted) + One(frame.overlaps()) + 0.5 * One(frame.skates()) +
        One(contacts.hands_meet && apart.value_or(0) > kHandsMetres) + One(through) +
        // Seen for longer than the frame in which they happen.
        5 * (One(turned > kPlaneDegrees) + One(fast)));
  }
  const body::Grade grade = sum.Get();
  const double fastest = *std::max_element(turns.begin(), turns.end());
  const body::BuildFigures build = body::MeasureBuild(skeleton_, body_, follower);
  const double frames = leader.frame_count();
  figures.values = {One(most_twisted > kTwistedClipDegrees),
                    grade.twisted,
                    shoulders / frames,
                    grade.skating,
                    grade.leader_skating,
                    heads / frames,
                    trunks / frames,
                    base::Mean(hands),
                    body::RootDistance(leader, follower, skeleton_),
                    body::JointSpeed(motion::WithoutNoise(follower, rate), rate),
                    body::JointSpeed(motion::WithoutNoise(leader, rate), rate),
                    limbs.share(),
                    One(plane > kPlaneDegrees),
                    One(fastest > kTurnDegreesPerSecond),
                    fastest,
                    body::MeasureLean(follower, skeleton_, rate, body::LeanFrom::kHips).max_degrees,
                    body::FacingDegrees(leader, follower, skeleton_),
                    FarthestRoots(skeleton_, leader, follower),
                    longest.Get(rate).astride,
                    longest.Get(rate).held_out,
                    build.HipsOff(),
                    build.hips_over_leg,
                    build.knee_degrees};
  return figures;
}

std::vector<double> Combine(const std::vector<PairFigures>& pairs) {
  const std::vector<PairFigure> figures = Plausibility::Figures();
  std::vector<double> combined;
  for (std::size_t c = 0; c < figures.size(); ++c) {
    std::vector<double> values;
    for (const PairFigures& pair : pairs) values.push_back(pair.values[c]);
    combined.push_back(figures[c].largest ? *std::max_element(values.begin(), values.end())
                                          : base::Mean(values));
  }
  return combined;
}

WorstPart FindWorstPart(const std::vector<double>& faults, int length) {
  const int frames = static_cast<int>(faults.size());
  double sum = 0;
  WorstPart worst;
  for (int t = 0; t < frames; ++t) {
    sum += faults[static_cast<std::size_t>(t)];
    if (t >= length) sum -= faults[static_cast<std::size_t>(t - length)];
    if (sum > worst.faults) worst = {std::max(0, t - length + 1), sum};
  }
  return worst;
}

}  // namespace duet::evaluation::experiments

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
#include "model/body/posture.h"
#include "model/motion/filter.h"
#include "model/retargeting/rig_fitting.h"

namespace duet::evaluation::experiments {
namespace {

using motion::Poses;

// A clip counts as twisted from this angle between shoulders and hips on, in any frame.
constexpr double kTwistedClipDegrees = 60;
// A joint that turns faster than this is a fault.
constexpr double kTurnDegreesPerSecond = 900;
// Offered hands that stay farther apart than this are a fault.
constexpr double kHandsMetres = 0.25;

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

}  // namespace

Plausibility::Plausibility(const motion::Skeleton& skeleton)
    : skeleton_(skeleton), body_(body::FindBody(skeleton)) {}

bool Plausibility::possible() const { return body::PairMeter::CanMeasure(skeleton_, body_); }

std::vector<PairFigure> Plausibility::Figures() {
  return {{"twisted clips"}, {"twisted"},        {"both feet"}, {"leader's"},
          {"heads"},         {"trunks"},         {"hands"},     {"distance"},
          {"speed"},         {"leader's speed"}, {"turns"},     {"lean"},
          {"facing"},        {"hips off", true}, {"hips"},      {"knees"}};
}

std::vector<std::string> Plausibility::Notes() {
  return {
      "Twisted clips: share of answers in which shoulders and hips differ by more than 60 degrees "
      "in any frame. Twisted: share of frames above 45 degrees. Both feet: "
      "share of frames in which the slower ankle moves faster than 10 cm/s; leader's: the same of "
      "the leaders.",
      "Heads, trunks: share of frames in which the heads are nearer than 18 cm, the axes of the "
      "trunks nearer than 16 cm. Hands: mean distance of the nearest hands while the leader "
      "reaches one out, metres. Distance: of the roots, metres. Speed: of the joints, m/s.",
      "Turns: share of answers in which a joint of the rig turns faster than 900 degrees a second. "
      "Lean: largest of the trunk over one second, degrees.",
      "Facing: how far hips and shoulders are turned away from the leader, mean over the frames, "
      "degrees.",
      "Hips off: by how much the hips are narrower or wider than their median width, as a share of "
      "it, in the worst frame of all answers. Hips: mean height of the hips above the lower foot, "
      "in lengths of the leg. Knees: mean bend, degrees."};
}

PairFigures Plausibility::Measure(const Poses& leader, const Poses& follower, double rate,
                                  const ClassContacts& contacts) const {
  body::PairMeter meter(skeleton_, body_, rate);
  body::GradeSum sum;
  const std::vector<double> turns = RigTurns(skeleton_, follower, rate);
  double most_twisted = 0, heads = 0, trunks = 0;
  std::vector<double> hands;
  PairFigures figures;
  for (int t = 0; t < leader.frame_count(); ++t) {
    const body::FrameMeasures frame = meter.Add(leader[t], follower[t]);
    sum.Add(frame);
    most_twisted = std::max(most_twisted, frame.twist_degrees);
    heads += frame.head_overlap > 0;
    trunks += frame.trunk_overlap > 0;
    const std::optional<double> apart =
        body::OfferedHandDistance(body_, skeleton_.root, leader[t], follower[t]);
    if (apart) hands.push_back(*apart);
    const bool fast = turns[static_cast<std::size_t>(t)] > kTurnDegreesPerSecond;
    figures.faults.push_back(One(frame.twisted()) + One(frame.overlaps()) +
                             0.5 * One(frame.skates()) +
                             One(contacts.hands_meet && apart.value_or(0) > kHandsMetres) +
                             5 * One(fast));  // seen for longer than the frame in which it happens
  }
  const body::Grade grade = sum.Get();
  const double fastest = *std::max_element(turns.begin(), turns.end());
  const body::BuildFigures build = body::MeasureBuild(skeleton_, body_, follower);
  const double frames = leader.frame_count();
  figures.values = {One(most_twisted > kTwistedClipDegrees),
                    grade.twisted,
                    grade.skating,
                    grade.leader_skating,
                    heads / frames,
                    trunks / frames,
                    base::Mean(hands),
                    body::RootDistance(leader, follower, skeleton_),
                    body::JointSpeed(motion::WithoutNoise(follower, rate), rate),
                    body::JointSpeed(motion::WithoutNoise(leader, rate), rate),
                    One(fastest > kTurnDegreesPerSecond),
                    body::MeasureLean(follower, skeleton_, rate, body::LeanFrom::kHips).max_degrees,
                    body::FacingDegrees(leader, follower, skeleton_),
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

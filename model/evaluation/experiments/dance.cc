#include "model/evaluation/experiments/dance.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "model/body/liveliness.h"
#include "model/body/penetration.h"
#include "model/body/posture.h"
#include "model/evaluation/experiments/answers.h"
#include "model/motion/filter.h"
#include "model/motion/steps.h"

namespace duet::evaluation::experiments {
namespace {

constexpr double kStretchSeconds = 4;

// A step is timed by the leader's nearest one within this time. Beyond it, the leader stands, and
// the follower steps alone.
constexpr double kSameStepSeconds = 0.5;

}  // namespace

TurnStretches FindTurnStretches(const dataset::Sequence& take, int turn_class,
                                double frame_rate_hz) {
  const int frames = take.pair.leader.frame_count();
  const int length = static_cast<int>(std::lround(kStretchSeconds * frame_rate_hz));
  std::vector<bool> led(static_cast<size_t>(frames));
  for (const dataset::LabelSpan& span : take.labels) {
    if (span.interaction_class != turn_class) continue;
    for (int t = span.begin; t < span.end; ++t) led[static_cast<size_t>(t)] = true;
  }
  TurnStretches stretches;
  for (int begin = 0; begin < frames;) {
    int end = begin;
    while (end < frames && led[static_cast<size_t>(end)] == led[static_cast<size_t>(begin)]) ++end;
    if (led[static_cast<size_t>(begin)]) {
      stretches.led.push_back({begin, end});
    } else {
      for (int t = begin; t + length <= end; t += length) {
        stretches.not_led.push_back({t, t + length});
      }
    }
    begin = end;
  }
  return stretches;
}

engine::LabelTrack LabelsWithTurn(const dataset::Sequence& take, int classes, int turn_class,
                                  const std::vector<FrameSpan>& stretches, double weight) {
  const engine::LabelTrack captured = TimeLineLabels(take, classes);
  std::vector<engine::LabelKeyframe> keyframes;
  for (int t = 0; t < take.pair.leader.frame_count(); ++t) {
    std::vector<float> weights(static_cast<size_t>(classes));
    captured.At(t, weights.data());
    const bool asked = std::any_of(
        stretches.begin(), stretches.end(),
        [t](const FrameSpan& stretch) { return stretch.begin <= t && t < stretch.end; });
    if (asked) {
      std::fill(weights.begin(), weights.end(), 0.0f);
      weights[static_cast<size_t>(turn_class)] = static_cast<float>(weight);
    }
    keyframes.push_back({t, std::move(weights)});
  }
  return engine::LabelTrack(std::move(keyframes));
}

int CountTurned(const std::vector<FrameSpan>& stretches, const std::vector<body::Turn>& turns,
                double frame_rate_hz) {
  return static_cast<int>(
      std::count_if(stretches.begin(), stretches.end(), [&](const FrameSpan& stretch) {
        return std::any_of(turns.begin(), turns.end(), [&](const body::Turn& turn) {
          const double frame = turn.middle() * frame_rate_hz;
          return stretch.begin <= frame && frame < stretch.end;
        });
      }));
}

std::vector<double> MeasureDance(const dataset::Dataset& dataset, const body::DanceJoints& joints,
                                 const motion::Poses& leader, const motion::Poses& follower,
                                 const motion::Poses* captured) {
  const double rate = dataset.frame_rate_hz;
  const auto turns = [&](const motion::Poses& person) {
    return body::FindTurns(joints, person, leader, rate);
  };
  const std::vector<body::Turn> made = turns(follower);
  double error = NAN, matched = NAN, delay = NAN;
  if (captured != nullptr) {
    const std::vector<body::Turn> original = turns(*captured);
    const body::TurnMatch match = body::MatchTurns(original, made);
    error = body::MeanError(follower, *captured);
    if (!original.empty()) matched = match.matched / static_cast<double>(original.size());
    delay = match.mean_delay;
  }
  const body::Holds holds = body::MeasureHolds(joints, leader, follower, rate);
  const motion::StepTiming steps =
      motion::MeasureStepTiming(motion::FindSteps(joints.feet, follower, rate),
                                motion::FindSteps(joints.feet, leader, rate), kSameStepSeconds);
  const int all_steps = steps.steps + steps.far;
  return {error,
          body::RootDistance(leader, follower, dataset.skeleton),
          body::FacingDegrees(leader, follower, dataset.skeleton),
          static_cast<double>(made.size()),
          matched,
          delay,
          holds.share,
          holds.mean_seconds,
          holds.slip,
          body::BothFeetMove(joints, follower, rate),
          steps.spread,
          body::JointSpeed(motion::WithoutNoise(follower, rate), rate),
          body::MeasureLean(follower, dataset.skeleton, rate, body::LeanFrom::kHips).max_degrees,
          body::MeasurePenetration(leader, follower, dataset.skeleton, dataset.parts).frequency,
          all_steps == 0 ? NAN : static_cast<double>(steps.far) / all_steps};
}

report::Table DanceTable(std::string title, const std::vector<DanceRow>& rows) {
  report::Table table{
      std::move(title),
      {"error", "distance", "facing", "turns", "matched", "delay", "held", "hold, s", "slip",
       "both feet", "steps", "speed", "lean", "overlap", "alone"}};
  for (const DanceRow& row : rows) {
    table.rows.push_back({row.name, report::ColumnMeans(row.takes)});
  }
  table.notes = {
      "Error: mean distance of a joint from the captured one, metres. Distance: of the roots, "
      "metres. Facing: angle between the follower's facing direction and the leader, degrees.",
      "Turns: rotations against the line between the people of at least 230 degrees. Matched: "
      "share of the captured turns with one the same way within 1.5 s. Delay: mean time between "
      "the middles of matched turns, seconds.",
      "Held: share of frames in which a wrist of one is less than 28 cm from a wrist of the other; "
      "hold: mean length of a hold, seconds; slip: speed of the two wrists against each other "
      "while held, m/s.",
      "Both feet: share of frames in which both are faster than 0.15 m/s. Steps: standard "
      "deviation of the time from a step to the leader's nearest one within 0.5 s, seconds. Speed: "
      "of the joints without noise, m/s. Lean: largest mean over one second of hips to neck, "
      "degrees. Overlap: share of frames in which the bodies overlap. Alone: share of the steps "
      "for which the leader has none within 0.5 s."};
  table.decimals = 3;
  return table;
}

}  // namespace duet::evaluation::experiments

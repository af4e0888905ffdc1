#include "model/evaluation/program/dance_figures.h"

#include <cmath>
#include <cstddef>
#include <utility>

#include "model/base/statistics.h"
#include "model/evaluation/metrics/liveliness.h"
#include "model/evaluation/metrics/penetration.h"
#include "model/evaluation/metrics/posture.h"
#include "model/motion/filter.h"
#include "model/motion/steps.h"

namespace duet::evaluation::program {
namespace {

std::vector<std::string> Columns() {
  return {"error", "distance",  "facing", "turns", "matched", "delay",   "held", "hold, s",
          "slip",  "both feet", "steps",  "speed", "lean",    "overlap", "alone"};
}

// A step is timed by the leader's nearest one within this time. Beyond it, the leader stands, and
// the follower steps alone.
constexpr double kSameStepSeconds = 0.5;

}  // namespace

std::vector<double> MeasureDance(const dataset::Dataset& dataset,
                                 const metrics::DanceJoints& joints, const motion::Poses& leader,
                                 const motion::Poses& follower, const motion::Poses* captured) {
  const double rate = dataset.frame_rate_hz;
  const auto turns = [&](const motion::Poses& person) {
    return metrics::FindTurns(joints, person, leader, rate);
  };
  const std::vector<metrics::Turn> made = turns(follower);
  double error = NAN, matched = NAN, delay = NAN;
  if (captured != nullptr) {
    const std::vector<metrics::Turn> original = turns(*captured);
    const metrics::TurnMatch match = metrics::MatchTurns(original, made);
    error = metrics::MeanError(follower, *captured);
    if (!original.empty()) matched = match.matched / static_cast<double>(original.size());
    delay = match.mean_delay;
  }
  const metrics::Holds holds = metrics::MeasureHolds(joints, leader, follower, rate);
  const motion::StepTiming steps =
      motion::MeasureStepTiming(motion::FindSteps(joints.feet, follower, rate),
                                motion::FindSteps(joints.feet, leader, rate), kSameStepSeconds);
  const int all_steps = steps.steps + steps.far;
  return {
      error,
      metrics::RootDistance(leader, follower, dataset.skeleton),
      metrics::FacingDegrees(leader, follower, dataset.skeleton),
      static_cast<double>(made.size()),
      matched,
      delay,
      holds.share,
      holds.mean_seconds,
      holds.slip,
      metrics::BothFeetMove(joints, follower, rate),
      steps.spread,
      metrics::JointSpeed(motion::WithoutNoise(follower, rate), rate),
      metrics::MeasureLean(follower, dataset.skeleton, rate, metrics::LeanFrom::kHips).max_degrees,
      metrics::MeasurePenetration(leader, follower, dataset.skeleton, dataset.parts).frequency,
      all_steps == 0 ? NAN : static_cast<double>(steps.far) / all_steps};
}

std::vector<double> ColumnMeans(const std::vector<std::vector<double>>& rows) {
  std::vector<double> means;
  for (size_t c = 0; !rows.empty() && c < rows.front().size(); ++c) {
    std::vector<double> values;
    for (const std::vector<double>& row : rows) values.push_back(row[c]);
    means.push_back(base::Mean(values));
  }
  return means;
}

report::Table DanceTable(std::string title, const std::vector<DanceRow>& rows) {
  report::Table table;
  table.title = std::move(title);
  table.columns = Columns();
  for (const DanceRow& row : rows) {
    table.rows.push_back({row.name, ColumnMeans(row.takes)});
  }
  table.notes = {
      "Error: mean distance of a joint from the captured one, metres. Distance: of the roots, "
      "metres. Facing: angle between the follower's facing direction and the leader, degrees.",
      "Turns: rotations against the line between the people of at least 230 degrees. Matched: "
      "share "
      "of the captured turns with one the same way within 1.5 s. Delay: mean time between the "
      "middles of matched turns, seconds.",
      "Held: share of frames in which a wrist of one is less than 28 cm from a wrist of the other; "
      "hold: mean length of a hold, seconds; slip: speed of the two wrists against each other "
      "while "
      "held, m/s.",
      "Both feet: share of frames in which both are faster than 0.15 m/s. Steps: standard "
      "deviation "
      "of the time from a step to the leader's nearest one within 0.5 s, seconds. Speed: of the "
      "joints without noise, m/s. Lean: largest mean over one second of hips to neck, degrees. "
      "Overlap: share of frames in which the bodies overlap. Alone: share of the steps for which "
      "the leader has none within 0.5 s."};
  table.decimals = 3;
  return table;
}

}  // namespace duet::evaluation::program

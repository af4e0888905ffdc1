#include "client/cli/beat_report.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "model/motion/steps.h"
#include "nlohmann/json.hpp"

namespace duet::client::cli {
namespace {

constexpr double kMillisecondsPerSecond = 1000;
constexpr char kNoFeet[] =
    "cannot find steps: the model has no feet (joints left_foot and right_foot, or left_ankle and "
    "right_ankle)";

motion::StepTiming Measure(const motion::Beat& beat, const motion::JointPair& feet,
                           const motion::Clip& person) {
  const double rate = person.frame_rate_hz;
  std::vector<double> steps = FindSteps(feet, person.poses, rate);
  const double begin = beat.SecondsAt(-0.5);
  steps.erase(steps.begin(), std::lower_bound(steps.begin(), steps.end(), begin));
  return motion::MeasureStepTiming(steps, BeatTimes(beat, person.frame_count() / rate));
}

std::string Describe(const motion::StepTiming& timing) {
  if (timing.steps == 0) return "no steps\n";
  std::string text = absl::StrFormat("%d %s, %.0f ms from the nearest beat on average",
                                     timing.steps, timing.steps == 1 ? "step" : "steps",
                                     timing.mean_distance * kMillisecondsPerSecond);
  if (!std::isnan(timing.spread)) {
    absl::StrAppendFormat(&text, ", spread %.0f ms", timing.spread * kMillisecondsPerSecond);
  }
  return text + "\n";
}

nlohmann::json ToJson(const motion::StepTiming& timing) {
  // JSON has no NaN: nlohmann writes null.
  return {{"steps", timing.steps},
          {"mean_distance_ms", timing.mean_distance * kMillisecondsPerSecond},
          {"spread_ms", timing.spread * kMillisecondsPerSecond}};
}

}  // namespace

std::string DescribeBeat(const Synthesis& synthesis) {
  const motion::Beat& beat = *synthesis.beat;
  std::string text = absl::StrFormat("beat      %g BPM, first beat at %.2f s\n", beat.per_minute,
                                     beat.first_seconds);
  if (!synthesis.skeleton.feet) return absl::StrCat(text, "          ", kNoFeet, "\n");
  const motion::ClipPair& pair = synthesis.result.pair;
  const motion::JointPair& feet = *synthesis.skeleton.feet;
  absl::StrAppend(&text, "          leader: ", Describe(Measure(beat, feet, pair.leader)));
  absl::StrAppend(&text, "          follower: ", Describe(Measure(beat, feet, pair.follower)));
  // Uniformly distributed distances from 0 to half a beat.
  absl::StrAppendFormat(&text, "          steps that ignore the beat: %.0f ms\n",
                        beat.period_seconds() / 4 * kMillisecondsPerSecond);
  return text;
}

nlohmann::json BeatJson(const Synthesis& synthesis) {
  const motion::Beat& beat = *synthesis.beat;
  nlohmann::json object = {{"bpm", beat.per_minute},
                           {"offset_seconds", beat.first_seconds},
                           {"leader", nullptr},
                           {"follower", nullptr}};
  if (!synthesis.skeleton.feet) {
    object["note"] = kNoFeet;
    return object;
  }
  const motion::JointPair& feet = *synthesis.skeleton.feet;
  object["leader"] = ToJson(Measure(beat, feet, synthesis.result.pair.leader));
  object["follower"] = ToJson(Measure(beat, feet, synthesis.result.pair.follower));
  return object;
}

}  // namespace duet::client::cli

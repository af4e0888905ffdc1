#include "model/evaluation/experiments/tilted_answers.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <tuple>
#include <utility>

#include "model/base/angle.h"
#include "model/base/status_macros.h"
#include "model/evaluation/metrics/scores.h"
#include "model/motion/levelling.h"
#include "model/motion/vertical.h"

namespace duet::evaluation::experiments {
namespace {

using motion::Levelling;
using motion::Vec3;

Vec3 TrueUp(const Camera& camera, const dataset::Sequence& sequence) {
  if (!camera.azimuth_degrees) return sequence.levelling.up();
  const double tilt = camera.tilt_degrees * base::kRadiansPerDegree;
  const double azimuth = *camera.azimuth_degrees * base::kRadiansPerDegree;
  return {static_cast<float>(std::sin(tilt) * std::cos(azimuth)),
          static_cast<float>(std::cos(tilt)),
          static_cast<float>(std::sin(tilt) * std::sin(azimuth))};
}

// Moves a sequence between worlds.
dataset::Sequence Moved(dataset::Sequence sequence, const std::function<Vec3(Vec3)>& move) {
  for (motion::Clip* clip : {&sequence.pair.leader, &sequence.pair.follower}) {
    for (Vec3& position : clip->poses.all()) position = move(position);
  }
  if (sequence.partner_direction) {
    Vec3 direction = move(*sequence.partner_direction) - move({});
    direction.y = 0;
    sequence.partner_direction = direction / Norm(direction);
  }
  return sequence;
}

// A sequence as captured, with its true vertical.
struct Capture {
  dataset::Sequence sequence;
  Levelling to_level;
};

double DegreesBetween(Vec3 a, Vec3 b) {
  return std::acos(std::clamp(static_cast<double>(Dot(a, b)), -1.0, 1.0)) * base::kDegreesPerRadian;
}

// The vertical of a strong estimate.
std::optional<Vec3> StrongUp(const motion::VerticalEvidence& evidence) {
  const motion::VerticalEstimate estimate = evidence.Estimate();
  if (estimate.verdict != motion::TiltVerdict::kTilted) return std::nullopt;
  return estimate.up;
}

// The verticals that requests state, in the order of `captures`.
using Verticals = std::vector<std::optional<Vec3>>;

// The verticals that all captures of one file or, `whole_sets`, of one set show.
Verticals Estimated(const motion::Skeleton& skeleton, const std::vector<Capture>& captures,
                    bool whole_sets) {
  const auto key = [&](size_t i) {
    return whole_sets ? captures[i].sequence.set : std::to_string(i);
  };
  std::map<std::string, motion::VerticalEvidence> evidence;
  for (size_t i = 0; i < captures.size(); ++i) {
    motion::VerticalEvidence& shown = evidence.try_emplace(key(i), skeleton).first->second;
    shown.Add(captures[i].sequence.pair.leader);
    shown.Add(captures[i].sequence.pair.follower);
  }
  std::map<std::string, std::optional<Vec3>> found;
  for (const auto& [name, shown] : evidence) found[name] = StrongUp(shown);
  Verticals verticals;
  for (size_t i = 0; i < captures.size(); ++i) verticals.push_back(found[key(i)]);
  return verticals;
}

Verticals True(const std::vector<Capture>& captures) {
  Verticals verticals;
  for (const Capture& capture : captures) verticals.emplace_back(capture.to_level.up());
  return verticals;
}

// Answers captures in a copy of the data set, as a server does for requests with these verticals.
struct Answerer {
  const engine::Synthesizer& synthesizer;
  const dataset::Dataset& dataset;
  const std::vector<int>& sequences;
  const StartGiven start;
  const AskedSamples& asked;

  absl::StatusOr<TiltedFigures> Answer(std::string name, const std::vector<Capture>& captures,
                                       const Verticals& verticals) const {
    dataset::Dataset sent = dataset;
    std::vector<Levelling> levellings;
    TiltedFigures figures{std::move(name)};
    const auto count = static_cast<double>(captures.size());
    for (size_t i = 0; i < captures.size(); ++i) {
      const Levelling levelling = verticals[i] ? Levelling(*verticals[i], 0) : Levelling();
      levellings.push_back(levelling);
      sent.sequences[static_cast<size_t>(sequences[i])] =
          Moved(captures[i].sequence, [&](Vec3 p) { return levelling.Apply(p); });
      figures.levelled_share += (verticals[i] ? 1 : 0) / count;
      figures.residual_degrees += DegreesBetween(captures[i].to_level.up(), levelling.up()) / count;
    }
    DUET_TRY(const auto answers, AnswerWithSamples(synthesizer, sent, sequences, start, asked));
    const auto samples = static_cast<double>(answers.size());
    for (const auto& answer : answers) {
      for (size_t i = 0; i < captures.size(); ++i) {
        const Levelling& to_level = captures[i].to_level;
        const motion::Poses level = to_level.Apply(levellings[i].Invert(answer[i].follower));
        const dataset::Sequence& truth = dataset.sequences[static_cast<size_t>(sequences[i])];
        figures.error_metres +=
            metrics::Afd(level, truth.pair.follower.poses, metrics::MetricUnit::kMetres) /
            (count * samples);
      }
    }
    return figures;
  }
};

std::vector<Capture> CaptureAll(const dataset::Dataset& dataset, const std::vector<int>& sequences,
                                const std::function<Vec3(const dataset::Sequence&)>& up) {
  std::vector<Capture> captures;
  for (const int index : sequences) {
    const dataset::Sequence& level = dataset.sequences[static_cast<size_t>(index)];
    const Levelling to_level(up(level), 0);
    captures.push_back({Moved(level, [&](Vec3 p) { return to_level.Invert(p); }), to_level});
  }
  return captures;
}

}  // namespace

absl::StatusOr<std::vector<TiltedFigures>> AnswerTilted(const engine::Synthesizer& synthesizer,
                                                        const dataset::Dataset& dataset,
                                                        const std::vector<int>& sequences,
                                                        StartGiven start, const AskedSamples& asked,
                                                        const Camera& camera) {
  const std::vector<Capture> level = CaptureAll(dataset, sequences, [](const dataset::Sequence&) {
    return Vec3{0, 1, 0};
  });
  const std::vector<Capture> tilted = CaptureAll(
      dataset, sequences, [&](const dataset::Sequence& one) { return TrueUp(camera, one); });
  const Answerer answerer{synthesizer, dataset, sequences, start, asked};
  const Verticals none(sequences.size());
  std::vector<TiltedFigures> rows;
  for (const auto& [name, captures, verticals] :
       std::vector<std::tuple<const char*, const std::vector<Capture>&, Verticals>>{
           {"never tilted", level, none},
           {"as sent", tilted, none},
           {"auto, one file", tilted, Estimated(dataset.skeleton, tilted, false)},
           {"auto, whole set", tilted, Estimated(dataset.skeleton, tilted, true)},
           {"true vertical", tilted, True(tilted)},
           {"auto, one file, never tilted", level, Estimated(dataset.skeleton, level, false)}}) {
    DUET_TRY(rows.emplace_back(), answerer.Answer(name, captures, verticals));
  }
  return rows;
}

}  // namespace duet::evaluation::experiments

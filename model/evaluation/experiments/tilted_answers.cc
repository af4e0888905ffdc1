#include "model/evaluation/experiments/tilted_answers.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <utility>

#include "model/base/angle.h"
#include "model/evaluation/metrics/displacement.h"
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

Verticals FromOneFile(const motion::Skeleton& skeleton, const std::vector<Capture>& captures) {
  Verticals verticals;
  for (const Capture& capture : captures) {
    motion::VerticalEvidence evidence(skeleton);
    evidence.Add(capture.sequence.pair.leader);
    evidence.Add(capture.sequence.pair.follower);
    verticals.push_back(StrongUp(evidence));
  }
  return verticals;
}

Verticals FromWholeSet(const motion::Skeleton& skeleton, const std::vector<Capture>& captures) {
  std::map<std::string, motion::VerticalEvidence> sets;
  for (const Capture& capture : captures) {
    motion::VerticalEvidence& evidence =
        sets.try_emplace(capture.sequence.set, skeleton).first->second;
    evidence.Add(capture.sequence.pair.leader);
    evidence.Add(capture.sequence.pair.follower);
  }
  std::map<std::string, std::optional<Vec3>> found;
  for (const auto& [set, evidence] : sets) found[set] = StrongUp(evidence);
  Verticals verticals;
  for (const Capture& capture : captures) verticals.push_back(found[capture.sequence.set]);
  return verticals;
}

Verticals True(const std::vector<Capture>& captures) {
  Verticals verticals;
  for (const Capture& capture : captures) verticals.emplace_back(capture.to_level.up());
  return verticals;
}

// Answers captures in a copy of the data set, as a server does for requests with these verticals.
class Answerer {
 public:
  Answerer(const engine::Synthesizer& synthesizer, const dataset::Dataset& dataset,
           const std::vector<int>& sequences, StartGiven start, const AskedSamples& asked)
      : synthesizer_(synthesizer),
        dataset_(dataset),
        sequences_(sequences),
        start_(start),
        asked_(asked) {}

  absl::StatusOr<TiltedFigures> Answer(std::string name, const std::vector<Capture>& captures,
                                       const Verticals& verticals) const {
    dataset::Dataset sent = dataset_;
    std::vector<Levelling> levellings;
    TiltedFigures figures{std::move(name)};
    const auto count = static_cast<double>(captures.size());
    for (size_t i = 0; i < captures.size(); ++i) {
      const Levelling levelling = verticals[i] ? Levelling(*verticals[i], 0) : Levelling();
      levellings.push_back(levelling);
      sent.sequences[static_cast<size_t>(sequences_[i])] =
          Moved(captures[i].sequence, [&](Vec3 p) { return levelling.Apply(p); });
      figures.levelled_share += (verticals[i] ? 1 : 0) / count;
      figures.residual_degrees += DegreesBetween(captures[i].to_level.up(), levelling.up()) / count;
    }
    const absl::StatusOr<metrics::SampledMotions> answers =
        AnswerWithSamples(synthesizer_, sent, sequences_, start_, asked_);
    if (!answers.ok()) return answers.status();
    const auto samples = static_cast<double>(answers->size());
    for (const auto& answer : *answers) {
      for (size_t i = 0; i < captures.size(); ++i) {
        const Levelling& to_level = captures[i].to_level;
        const motion::Poses level = to_level.Apply(levellings[i].Invert(answer[i].follower));
        const dataset::Sequence& truth = dataset_.sequences[static_cast<size_t>(sequences_[i])];
        figures.error_metres +=
            metrics::Afd(level, truth.pair.follower.poses, metrics::MetricUnit::kMetres) /
            (count * samples);
      }
    }
    return figures;
  }

 private:
  const engine::Synthesizer& synthesizer_;
  const dataset::Dataset& dataset_;
  const std::vector<int>& sequences_;
  const StartGiven start_;
  const AskedSamples& asked_;
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
  const Answerer answerer(synthesizer, dataset, sequences, start, asked);
  const Verticals none(sequences.size());
  std::vector<TiltedFigures> rows;
  absl::Status status;
  const auto add = [&](const char* name, const std::vector<Capture>& captures,
                       const Verticals& verticals) {
    if (!status.ok()) return;
    absl::StatusOr<TiltedFigures> row = answerer.Answer(name, captures, verticals);
    status = row.status();
    if (row.ok()) rows.push_back(*std::move(row));
  };
  add("never tilted", level, none);
  add("as sent", tilted, none);
  add("auto, one file", tilted, FromOneFile(dataset.skeleton, tilted));
  add("auto, whole set", tilted, FromWholeSet(dataset.skeleton, tilted));
  add("true vertical", tilted, True(tilted));
  add("auto, one file, never tilted", level, FromOneFile(dataset.skeleton, level));
  if (!status.ok()) return status;
  return rows;
}

}  // namespace duet::evaluation::experiments

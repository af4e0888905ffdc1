#include "model/training/take_errors.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>

#include "model/base/random.h"
#include "model/engine/clip_synthesis.h"
#include "model/engine/clips_together.h"
#include "model/engine/network_synthesizer.h"
#include "model/training/frame_labels.h"

namespace duet::training {
namespace {

// The network as it is now, in the engine's pipeline.
class NetworkInTraining : public engine::Network {
 public:
  explicit NetworkInTraining(AnswerWindows answer) : answer_(std::move(answer)) {}

  absl::StatusOr<std::vector<motion::Poses>> Run(
      absl::Span<const engine::NetworkInput> inputs) const override {
    return answer_(inputs);
  }

 private:
  const AnswerWindows answer_;
};

int PositionFrames(double frame_rate_hz) {
  return std::max(1, static_cast<int>(kPositionSeconds * frame_rate_hz));
}

// The labels of the take's time line, frame by frame.
engine::LabelTrack TimeLine(const dataset::Sequence& take, int classes) {
  base::Random unused(0);
  const std::vector<float> weights = DrawFrameLabels(take, classes, {}, &unused);
  std::vector<engine::LabelKeyframe> keyframes;
  for (int t = 0; t < take.pair.leader.frame_count(); ++t) {
    const auto begin = weights.begin() + static_cast<std::ptrdiff_t>(t) * classes;
    keyframes.push_back({t, {begin, begin + classes}});
  }
  return engine::LabelTrack(std::move(keyframes));
}

engine::ClipRequest RequestFor(const engine::ModelDescription& model,
                               const dataset::Sequence& take) {
  engine::ClipRequest request{take.pair.leader.poses, model.frame_rate_hz,
                              TimeLine(take, model.class_count()), std::nullopt,
                              take.partner_direction};
  request.options.sampling.variety = 0;
  if (!model.accepts_follower_start) return request;
  const motion::Clip& follower = take.pair.follower;
  request.start = engine::FollowerStart{follower.at(0, model.skeleton.root),
                                        {follower.poses[0].begin(), follower.poses[0].end()}};
  return request;
}

double MeanDistance(const motion::Poses& a, const motion::Poses& b, int first, int count) {
  double sum = 0;
  for (int t = first; t < first + count; ++t) {
    for (int j = 0; j < a.joint_count(); ++j) sum += double{Distance(a.at(t, j), b.at(t, j))};
  }
  return sum / (static_cast<double>(count) * a.joint_count());
}

}  // namespace

int PositionCount(absl::Span<const dataset::Sequence> takes, double frame_rate_hz) {
  int longest = 0;
  for (const dataset::Sequence& take : takes) {
    longest = std::max(longest, take.pair.leader.frame_count());
  }
  return longest / PositionFrames(frame_rate_hz);
}

absl::StatusOr<std::vector<double>> ErrorByPosition(const checkpoint::Manifest& manifest,
                                                    absl::Span<const dataset::Sequence> takes,
                                                    const AnswerWindows& answer) {
  engine::PipelineOptions options;
  options.clean_up = false;
  const std::unique_ptr<engine::Synthesizer> synthesizer =
      MakeSynthesizer(manifest.model, manifest.standardisation,
                      std::make_unique<const NetworkInTraining>(answer), options);
  std::vector<engine::ClipSynthesis> clips;
  for (const dataset::Sequence& take : takes) {
    clips.emplace_back(manifest.model, RequestFor(manifest.model, take));
  }
  absl::StatusOr<std::vector<motion::Poses>> followers = SynthesizeTogether(*synthesizer, &clips);
  if (!followers.ok()) return followers.status();
  const int length = PositionFrames(manifest.model.frame_rate_hz);
  std::vector<double> errors(
      static_cast<std::size_t>(PositionCount(takes, manifest.model.frame_rate_hz)));
  for (std::size_t p = 0; p < errors.size(); ++p) {
    const int first = static_cast<int>(p) * length;
    int filled = 0;
    for (std::size_t i = 0; i < takes.size(); ++i) {
      const motion::Poses& captured = takes[i].pair.follower.poses;
      if (first + length > captured.frame_count()) continue;
      errors[p] += MeanDistance((*followers)[i], captured, first, length);
      ++filled;
    }
    errors[p] /= filled;
  }
  return errors;
}

}  // namespace duet::training

#include "model/training/sampler.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "model/engine/windows.h"

namespace duet::training {
namespace {

// Random perturbation of the order by length, frames, so that batches differ between epochs.
constexpr double kLengthJitter = 2;

std::vector<int> OrderByLength(const std::vector<dataset::Sequence>& sequences,
                               base::Random* random) {
  std::vector<double> key;
  for (const dataset::Sequence& sequence : sequences) {
    key.push_back(sequence.pair.leader.frame_count() + random->Normal(kLengthJitter));
  }
  std::vector<int> order(sequences.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return key[static_cast<size_t>(a)] < key[static_cast<size_t>(b)];
  });
  return order;
}

// Cuts [0, count) into batches that differ by at most one in size.
std::vector<std::vector<int>> Cut(const std::vector<int>& order, int64_t batch) {
  const int64_t count = static_cast<int64_t>(order.size()), pieces = (count + batch - 1) / batch;
  std::vector<std::vector<int>> cut;
  for (int64_t i = 0; i < pieces; ++i) {
    cut.emplace_back(order.begin() + count * i / pieces, order.begin() + count * (i + 1) / pieces);
  }
  return cut;
}

std::optional<engine::FollowerStart> StartOf(const motion::Skeleton& skeleton,
                                             const motion::Clip& follower,
                                             StartKnowledge knowledge) {
  if (knowledge == StartKnowledge::kNone) return std::nullopt;
  engine::FollowerStart start{follower.at(0, skeleton.root), {}};
  if (knowledge == StartKnowledge::kPose) {
    start.pose.assign(follower.poses[0].begin(), follower.poses[0].end());
  }
  return start;
}

std::vector<const motion::Poses*> Pointers(const std::vector<motion::Poses>& clips) {
  std::vector<const motion::Poses*> pointers;
  for (const motion::Poses& clip : clips) pointers.push_back(&clip);
  return pointers;
}

// Draws one of the classes on a sequence's time line, by the number of frames that each covers.
void DrawClass(base::Random* random, dataset::Sequence* sequence) {
  int frames = 0;
  for (const dataset::LabelSpan& span : sequence->labels) frames += span.end - span.begin;
  if (frames == 0) return;
  int drawn = static_cast<int>(random->Below(frames));
  for (const dataset::LabelSpan& span : sequence->labels) {
    sequence->interaction_class = span.interaction_class;
    drawn -= span.end - span.begin;
    if (drawn < 0) return;
  }
}

}  // namespace

StartKnowledge DrawStart(const CommonSettings::Start& start, base::Random* random) {
  const double draw = random->Uniform(0, 1);
  if (draw < start.pose()) return StartKnowledge::kPose;
  return draw < start.pose() + start.root() ? StartKnowledge::kRoot : StartKnowledge::kNone;
}

std::vector<dataset::Sequence> AugmentAll(const dataset::Dataset& dataset,
                                          const std::vector<int>& train,
                                          const TrainingOptions& options, base::Random* random) {
  std::vector<dataset::Sequence> sequences;
  for (int index : train) {
    dataset::Sequence sequence = dataset.sequences[static_cast<size_t>(index)];
    DrawClass(random, &sequence);
    sequences.push_back(Augment(dataset, sequence, options.common.augmentation(), random));
  }
  return sequences;
}

std::vector<std::vector<int>> BatchesByLength(const std::vector<dataset::Sequence>& sequences,
                                              int64_t batch, base::Random* random) {
  std::vector<std::vector<int>> pieces = Cut(OrderByLength(sequences, random), batch);
  random->Shuffle(&pieces);
  return pieces;
}

engine::SynthesisWindow MakeWindow(const dataset::Dataset& dataset, const Example& example) {
  const dataset::Sequence& sequence = example.sequence;
  engine::SynthesisWindow window;
  window.leader = sequence.pair.leader.poses;
  for (int t = 0; t < sequence.pair.leader.frame_count(); ++t) {
    window.labels.insert(window.labels.end(), example.weights.begin(), example.weights.end());
  }
  window.start = StartOf(dataset.skeleton, sequence.pair.follower, example.start);
  window.partner_direction = sequence.partner_direction;
  return window;
}

TrainingBatch MakeBatch(const checkpoint::Manifest& manifest, const dataset::Dataset& dataset,
                        const std::vector<Example>& examples) {
  std::vector<engine::NetworkInput> inputs;
  std::vector<motion::Poses> targets, followers;
  std::vector<int64_t> classes, single_rows;
  for (const Example& example : examples) {
    const engine::SynthesisWindow window = MakeWindow(dataset, example);
    const motion::Standardisation frame =
        WindowStandardisation(dataset.skeleton, window, manifest.standardisation);
    inputs.push_back(Standardise(frame, window));
    targets.push_back(frame.Apply(example.target));
    followers.push_back(frame.Apply(example.sequence.pair.follower.poses));
    if (example.single) single_rows.push_back(static_cast<int64_t>(classes.size()));
    classes.push_back(example.sequence.interaction_class);
  }
  TrainingBatch batch;
  batch.input = network::MakeInput(manifest, inputs);
  const int64_t frames = batch.input.leader.size(1);
  batch.target = network::PadPoses(Pointers(targets), frames);
  batch.follower = network::PadPoses(Pointers(followers), frames);
  batch.classes = torch::tensor(classes);
  batch.single_rows = torch::tensor(single_rows, torch::kInt64);
  return batch;
}

std::vector<TrainingBatch> SampleEpoch(const checkpoint::Manifest& manifest,
                                       const dataset::Dataset& dataset,
                                       const std::vector<int>& train,
                                       const TrainingOptions& options, int64_t epoch) {
  base::Random random(options.common.seed(), epoch);
  const std::vector<dataset::Sequence> sequences = AugmentAll(dataset, train, options, &random);
  const std::vector<std::vector<int>> pieces =
      BatchesByLength(sequences, options.common.batch(), &random);
  const double graded_labels = options.paper.graded_labels();
  std::vector<TrainingBatch> batches;
  for (const std::vector<int>& piece : pieces) {
    std::vector<Example> examples;
    for (int index : piece) {
      const StartKnowledge start = manifest.model.accepts_follower_start
                                       ? DrawStart(options.common.start(), &random)
                                       : StartKnowledge::kNone;
      examples.push_back(CapturedExample(dataset, sequences[static_cast<size_t>(index)], start));
      if (random.Chance(graded_labels)) {
        GradeLabels(dataset, sequences, &random, &examples.back());
      }
    }
    batches.push_back(MakeBatch(manifest, dataset, examples));
  }
  return batches;
}

torch::Tensor ClassMeanPoses(const checkpoint::Manifest& manifest, const dataset::Dataset& dataset,
                             const std::vector<int>& train) {
  const int64_t joints = dataset.skeleton.joint_count();
  const int64_t classes = static_cast<int64_t>(dataset.classes.size());
  torch::Tensor sums = torch::zeros({classes, 3 * joints}), counts = torch::zeros({classes, 1});
  for (int index : train) {
    const dataset::Sequence& sequence = dataset.sequences[static_cast<size_t>(index)];
    const TrainingBatch one =
        MakeBatch(manifest, dataset, {CapturedExample(dataset, sequence, StartKnowledge::kNone)});
    sums[sequence.interaction_class] += one.follower[0].mean(0);
    counts[sequence.interaction_class] += 1;
  }
  return sums / counts.clamp_min(1);
}

namespace {

// A frame within the clip stays within it; its ends stay ends.
int Shifted(int frame, int frames, double deviation, base::Random* random) {
  if (frame <= 0 || frame >= frames) return frame;
  return std::clamp(frame + static_cast<int>(std::lround(random->Normal(deviation))), 0, frames);
}

}  // namespace

std::vector<float> DrawFrameLabels(const dataset::Sequence& sequence, int classes,
                                   const FlowSettings::FrameLabels& options, base::Random* random) {
  const int frames = sequence.pair.leader.frame_count();
  std::vector<dataset::LabelSpan> spans = sequence.labels;
  if (spans.empty()) spans.push_back({sequence.interaction_class, 0, frames});
  std::vector<float> weights(static_cast<std::size_t>(frames) * static_cast<std::size_t>(classes));
  const auto at = [&](int frame, int c) -> float& {
    return weights[static_cast<std::size_t>(frame) * static_cast<std::size_t>(classes) +
                   static_cast<std::size_t>(c)];
  };
  for (const dataset::LabelSpan& span : spans) {
    const int begin = Shifted(span.begin, frames, options.shift(), random);
    const int end = Shifted(span.end, frames, options.shift(), random);
    for (int t = begin; t < end; ++t) at(t, span.interaction_class) = 1;
  }
  for (int c = 0; c < classes; ++c) {
    const bool unlabelled = random->Chance(options.unlabelled());
    const bool avoided = random->Chance(options.avoided());
    for (int t = 0; t < frames; ++t) {
      if (unlabelled) at(t, c) = 0;
      if (avoided && !unlabelled && at(t, c) == 0) at(t, c) = -1;
    }
  }
  return weights;
}

}  // namespace duet::training
